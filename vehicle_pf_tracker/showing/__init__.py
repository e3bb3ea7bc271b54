# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Showing estimates: drawn into images, videos and pages.

- into an image: `drawing` has words, boxes and labels, `target_drawing` given targets,
  `traffic_drawing` all vehicles, `grids` pixels and metres
- of a run while it goes on: `pictures`, which are a `video_file`, a `contact_sheet` and the
  `live_page` on a `page_server`; `estimates_recording` for other viewers
- of a whole run of `traffic`: `traffic_pictures`, which are a `path_picture` of `lanes` and a
  `heat_picture`

What fails costs itself only: `side_products` notes it.
"""
