"""The ROS 2 layer: conversions, parameters, diagnostics, the node, the bag player."""
