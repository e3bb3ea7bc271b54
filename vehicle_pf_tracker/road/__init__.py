# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mapping of pixels to the plane of the road: homography, lens, pose, motion.

`plane` maps, by a `homography` and a `lens`, or by `poses` of the camera; `suspects` are pairs of
points that do not agree with the others; `motion` is the speed. Of the other rooms it imports
`core` alone.
"""
