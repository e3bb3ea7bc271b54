# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fast measurement of windows: one interface, implemented in OpenCV and numpy, and in numba."""
