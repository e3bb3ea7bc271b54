"""The ROS 2 layer: messages, the transport of images, the node and the replay."""
