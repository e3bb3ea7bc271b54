# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images and truth in and out of files: recordings, frame folders, videos, cameras.

- `source` opens any of them by its name; `recording_names` recognises recordings
- footage is all but recordings: `footage` its contract, `opened_footage` the choice of
  `frame_folder` (with `image_names`, `name_times`), `video` (with `decoders`) and `live_camera`
- `bags/`: recordings of ROS; `importing` makes one of footage, `url_copies` fetches them
- `truth/`: formats of truth; `text_tables` and `box_sizes` are for detections, too
"""
