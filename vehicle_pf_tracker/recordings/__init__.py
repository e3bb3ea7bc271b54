# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images and truth in and out of files: rosbag2 MCAP, frame folders, videos."""
