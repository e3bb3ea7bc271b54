# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measurements in the image. A module has one of them, and knows no tracker.

- images: `encodings` and `compressed_image` make frames of messages and files
- windows of many particles: `window` says what a feature is; `colour`, `gradients`, `textures` and
  `lines` are features, counted by `bin_counting` and compared by `similarity`; `mean_shift`;
  `kernels/` has the same, compiled
- one target at a canonical size: `canonical_patch`, `gradient_cells`, `correlation_filter` with
  `spectra`, `map_search`
- motion: `point_flow` of points, `shared_motion` of most of them, `box_motion` of those in a box,
  `camera_flow` of the background of a `small_grey` frame, which makes a `camera_motion`
- what moves and what does not: `foreground`, `stillness`; `target_pixels` doubts a target
"""
