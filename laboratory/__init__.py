# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Programs that fit, judge and compare the trackers; not installed."""
