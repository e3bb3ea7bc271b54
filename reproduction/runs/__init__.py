# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The runs of experiments.

- `cells`: a run, as a value: scene, tracker, seed, and what is recorded of it
- `timing_cell`: a run whose time is measured
- `running`: runs shared among processes, each result kept under its cache key
"""
