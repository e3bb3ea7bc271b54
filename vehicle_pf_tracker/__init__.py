"""Particle-filter vehicle tracking through occlusions, for ROS 2 and for recordings."""

__version__ = "0.1.0"
