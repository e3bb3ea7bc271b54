# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Patches described by cells, and what was learnt of them.

- `cells`: histograms of gradients, and mean colours
- `side_network`: where a vehicle ends, by a small network; its file lies beside it
"""
