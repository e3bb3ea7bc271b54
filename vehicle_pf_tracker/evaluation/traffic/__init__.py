# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Trackers of many vehicles, compared on folders as MOTChallenge has them.

- `comparison` runs a `case_run` of ours and `baselines` on each `sequence`, `comparison_report`
  writes
- scores of its own, beside those of TrackEval: `followed`, `identities`, `middle_line` and
  `line_counts`, over `scorable` boxes and their `box_matches`
"""
