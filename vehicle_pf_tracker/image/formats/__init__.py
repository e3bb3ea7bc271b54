# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Frames of messages and files.

- `encodings`: raw camera images, in each encoding of ROS
- `compressed_image`: JPEG and PNG, read and written
"""
