# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Recordings of ROS: rosbag2 folders in MCAP or SQLite, read and written without ROS.

`reader.Recording` reads a whole or damaged one, `writer.RecordingWriter` writes one. Below them:

- `bag_folder`: which files a folder has, and its metadata.yaml; `topic_table`: its topics
- `mcap_index`, `mcap_blocks`, `sqlite_index`: where messages lie in a file
- `merged_messages`: the messages of all files in the order of time; `read_notices`: what is damaged
- `messages`: the ROS messages, and their CDR bytes; `truth_messages`: the truth among them
"""
