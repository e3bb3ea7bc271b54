# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The report of an evaluation, as one page and as tables.

`writing` writes it. `scored_runs` scores the cells of the folder, `aggregates` sums them up over
seeds and recordings; `page`, `figures` and `stills` show them.
"""
