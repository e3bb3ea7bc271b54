# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The grid of an evaluation: recordings by systems by seeds, each cell one stored run.

`sources` finds the recordings, and `cells` lists the cells. `running` runs those that are missing,
and stores each under its cache key; `merging` joins parts that ran on several machines.
"""
