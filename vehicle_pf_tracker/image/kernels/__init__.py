"""How windows are measured fast: one interface, in OpenCV and numpy, or in numba."""
