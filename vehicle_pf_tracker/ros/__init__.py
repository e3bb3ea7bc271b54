# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The ROS 2 layer: messages, the transport of images, the nodes and the replay.

- `node/`: the node of one target, and the base of both kinds; `traffic/`: the node of many
  vehicles; `video_source/`: the node that publishes a source; `replay/`: recordings to nodes
- programs: `executables` starts any node in a `process` of its own, with the `node_executor`;
  `camera_file` lists one node for each camera; `launching` is what launch files share
- messages: `messages` of estimates, `target_messages` of targets, `serialized_image` for images
  read in place, `reading` of bytes that may be no message; `target_request` publishes a target
- memory and transport: `transport` (shared memory for Fast DDS), `image_memory`, `library_memory`
- `own_files` in ROS's folder; `rclpy_internals`, the only module that names private parts of rclpy
"""
