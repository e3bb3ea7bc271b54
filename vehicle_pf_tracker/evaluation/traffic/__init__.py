# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many vehicles offline: files of detections and tracks, runs, scores and baselines."""
