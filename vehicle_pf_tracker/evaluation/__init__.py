# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Judging trackers: scores against truth, repeated runs, baselines, reports and tuning.

- one run: `scores` of each frame, `occlusion_scores`, and of these `metrics` and `curves`;
  `restarts` after failures; `columns` says how metrics are shown
- many runs: `grid/` runs `systems` on recordings, over seeds, into an `evaluation_folder`, each
  under its `cache_key`; `statistics` and `tables` sum up, `report/` writes
- figures, also those of other folders, have the same `line_styles`, and shade the
  `occlusion_stretches`
- `baselines` are OpenCV's trackers, each in a `baseline_process` that runs `baseline_worker`
- `tuning` searches a `search_space` for `tuning_aims`
- `traffic/` is the comparison of trackers of many vehicles
"""
