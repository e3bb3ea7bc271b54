# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The first paper (P1, Scharcanski et al. 2011): its experiments and what came of it."""

from __future__ import annotations

from reproduction.apf import (
    fig1,
    fig2,
    fig3,
    fig4,
    fig5,
    fig6,
    fig7,
    systems,
    table1,
    table2,
    timing,
)
from reproduction.paper import Paper

_IN_ORDER = (fig1, fig2, fig3, fig4, fig5, fig6, fig7, table1, table2, timing)

PAPER = Paper(
    "Scharcanski et al. 2011: APF",
    "APF",
    "The main claim holds: over the twenty videos it has the smallest mean error of the six "
    "trackers, and it comes through most total occlusions, at which its rivals lose the "
    "vehicle. It does not lead on every video, and the best spread of the particles is not "
    "half the speed. As printed it loses the vehicle.",
    systems.SIGMA_RULE,
    tuple(module.EXPERIMENT for module in _IN_ORDER),
)
