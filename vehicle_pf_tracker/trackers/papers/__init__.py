# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Variants after papers, and the bases and parameters that they share.

P1 is Scharcanski et al. 2011, P2 Abdulla et al. 2022, P3 Khong et al.; docs/interpretations.md has
their titles, and by number each interpretation of what they leave open or misprint. The `_advance`
of a variant is its step of one frame, with the paper's numbers of steps and equations.

- P1: `apf`, with `clear_level`, our extension of its occlusion test; and the trackers that it
  compares itself with: `pf`, the smallest, `sapf`, `hpfms` and `pfcl`, by the steps of
  `colour_tracker`, and `ms`
- P2: `mfpf` and `sfpf`, with `mfpf_parameters` and `feature_weighting`
- P3: `repeated_resampling`, which has `conventional` and `adaptive`, also by `colour_tracker`
- `shared`: likelihood, mean velocity and parameters of several papers
"""
