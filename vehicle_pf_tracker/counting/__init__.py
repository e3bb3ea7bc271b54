# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Counting: lines and zones that vehicles cross, and which crossings are plausible."""
