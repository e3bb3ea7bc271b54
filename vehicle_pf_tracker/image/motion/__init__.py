# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Motion between images, and what moves before a standing camera.

- `point_flow`: motion of points, on which the others are built
- `shared_motion`: the motion that most points share
- `box_motion`: turn and stretch of the points in a box
- `explained_variance`: how well dense flow explains an image by an earlier one
- `camera_motion`: motion of the background, measured by `camera_flow` in a `small_grey` frame
- `camera_drift`: whether a camera that moves only sways
- `foreground`: pixels that differ from the background of a standing camera, a `median_image` of its
  `kept_frames`, each a `carried_grey` frame that follows a camera that sways
- `mask_parts`: connected parts of such a mask; `side_edges`: where it ends at the sides of a box
"""
