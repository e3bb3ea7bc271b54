# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The third paper (P3, Khong et al.): its experiments and what came of it."""

from __future__ import annotations

from reproduction.paper import Paper
from reproduction.resampling import cost, fig4, fig5, frames, systems

_IN_ORDER = (fig4, fig5, frames, cost)

PAPER = Paper(
    "Khong et al.: adaptive resampling",
    "Adaptive resampling",
    "The saving is confirmed: it takes fewer passes, resamples fewer particles and needs less "
    "time. That it finds the vehicle again where the conventional filter has lost it is not: "
    "both mostly do.",
    systems.INTERPRETATIONS_NOTE,
    tuple(module.EXPERIMENT for module in _IN_ORDER),
)
