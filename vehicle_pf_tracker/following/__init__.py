# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Following vehicles through a source without ROS.

- one vehicle: `offline_tracker` follows it frame by frame, `target_following` several through one
  source, `library` for Python programs
- all vehicles: `counted_vehicles` follows and counts image by image, `traffic_following` through a
  source, `traffic_library` for Python programs
- `live_facts`: the numbers of both for a page
- detections: `detectors` makes the detector that parameters ask for, `paced_detector` lets it look
  at every k-th image, `networks/` loads its network; `detection_file` reads them from a file
"""
