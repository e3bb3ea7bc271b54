# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Counting: lines and zones that vehicles cross, and which crossings are plausible.

- one vehicle: a `foot_point` for each image, `recent_path`; `side_watch` decides on which side of
  an edge it is, `line_watch` and `zone_watch` what it has crossed; `watched_vehicle` has them all
- all vehicles: `counter` makes each `crossing` once, `plausibility` doubts it; `vehicle_class`
- trust: `count_signs` says how crossings were seen, `sign_tally` adds them up, and `trust` makes
  the interval of the true count of them
- `zone_occupancy`: how many vehicles were in each zone, interval by interval
"""
