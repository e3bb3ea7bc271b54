"""Fast measurement of windows: one interface, implemented in OpenCV and numpy, and in numba."""
