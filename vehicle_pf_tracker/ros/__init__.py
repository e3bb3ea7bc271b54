# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The ROS 2 layer: messages, the transport of images, the node and the replay."""
