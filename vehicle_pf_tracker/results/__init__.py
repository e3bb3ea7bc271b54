# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files that a run leaves: tables, summaries and folders.

It imports the rooms that track and count, and draws nothing itself.
"""
