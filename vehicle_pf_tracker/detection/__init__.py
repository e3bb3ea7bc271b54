# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detectors: motion before a standing camera, and boxes of networks."""
