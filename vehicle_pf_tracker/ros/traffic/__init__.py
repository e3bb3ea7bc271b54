# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The node that follows every vehicle in view; its base is that of `ros.node`.

- `traffic_node`, with its `traffic_feed`; `vehicles` are followed, counted and added by hand
- detections of another node: `detection_queue` holds `waiting_images` until those of their stamp
- out: `outputs` publishes `messages`; `live_page` is for browsers
"""
