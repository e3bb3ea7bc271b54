# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Trackers: their contract, the variants, and the registry.

- `base` is the frame around a variant's step, and takes it from `registry`; `estimate` is what it
  gives, its mode from `evidence`; `parameters` are those that variants share
- `session` takes stamped images: `image_stream` admits them, with `continuity`; `attempts` bears a
  tracker's errors; `rehearsal` compiles before the first
- beside the tracker: `localisation` has `uncertainty`, calibrated by the `uncertainty_table`, and a
  `road_follower`
- the variants: `papers/`, `fusion/`; and `traffic/`, the tracker of many vehicles
"""
