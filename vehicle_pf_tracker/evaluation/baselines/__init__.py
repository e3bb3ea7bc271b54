"""OpenCV's trackers to compare with, in a process and an environment of their own."""
