# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion`, the flagship: a correlation particle filter with a posterior over visibility.

`tracker.py` has its step, in the order of the chart in docs/fusion.md.
"""
