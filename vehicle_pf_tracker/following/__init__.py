# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Following vehicles through a source without ROS.

`driver` follows given targets, `traffic_following` all vehicles; `library` and `traffic_library`
are the interfaces for Python programs. The other modules load networks, and share work among
processes and machines. It may import every room but `ros`, `evaluation` and `cli`, which are above.
"""
