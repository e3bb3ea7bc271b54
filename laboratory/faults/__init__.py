# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Faults that cameras, detectors, files and people make, given to nodes and commands."""
