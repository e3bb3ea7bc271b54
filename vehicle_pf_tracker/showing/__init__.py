# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Showing estimates: drawn into images, videos and pages.

It may import `results` and the rooms below that; only `following` and the rooms above use it.
"""
