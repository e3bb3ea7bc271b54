# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measurements in the image. A module has one of them, and knows no tracker.

- `formats/`: messages and files become frames
- `windows/`: many windows of a frame, each described by a histogram, compared with a reference
- `kernels/`: the same, compiled
- `correlation/`: one target at a canonical size, and the filter that finds it again
- `motion/`: motion of points, of a box and of the camera, and what moves before a standing one
- `patches/`: patches described by cells, in which a network sees where a vehicle ends
- `target_checks/`: doubts about a target, reported to the user
"""
