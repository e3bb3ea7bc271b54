# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracker node: images in, estimates out. docs/development.md walks one image through it.

Both kinds of node have:

- `image_node`: the base: lifecycle, services, subscriptions. `parameters` declares the table
- in: `image_input` subscribes and reads, `arrivals` counts; `camera_inputs` follow `camera_info`
  and TF; `kernel_loading` compiles meanwhile
- through: `image_path` feeds each image to a tracker, and gives one `answer` to it
- out: `publishers`; `diagnostics` publishes the `health` once a second, `journal` writes to the log
  by `notices`; `incidents` records the last seconds

The node of one target besides:

- `tracker_node`, with its `tracker_feed` (the session), its `tracker_outputs`, and
  `stream_localisation` (covariance and road); `kept_target` survives a restart
"""
