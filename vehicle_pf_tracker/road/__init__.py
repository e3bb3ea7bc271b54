# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""From pixels to the plane of the road: homography, lens, pose, motion."""
