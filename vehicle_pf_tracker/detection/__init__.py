# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detectors: motion before a standing camera, and boxes of networks.

- `detector` is what both are, `detections` what they report, `parameters` what users set
- motion: `motion_detector` compares images, which `stabilising` has moved, with the `background`,
  which follows the camera's `exposure` and learns `holes` of what has left at once; `blobs` of the
  mask become `pieces` and boxes, by the `usual_size` of vehicles and `motion_thresholds`
- networks: `network_detector` fits images in (`network_input`), runs a loaded `network`, and reads
  its answer (`network_outputs`, `network_classes`)
"""
