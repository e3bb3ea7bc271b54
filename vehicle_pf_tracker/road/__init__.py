# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mapping of pixels to the plane of the road: homography, lens, pose, motion.

Of the other rooms it imports `core` alone.
"""
