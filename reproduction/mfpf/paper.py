# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The second paper (P2, Abdulla et al. 2022): its experiments and what came of it."""

from __future__ import annotations

from reproduction.mfpf import (
    errors,
    fig2,
    frames,
    histograms,
    similarities,
    systems,
    table1,
    table2,
    table3,
    timing,
)
from reproduction.paper import Paper

_IN_ORDER = (table1, table2, table3, similarities, errors, frames, histograms, fig2, timing)

PAPER = Paper(
    "Abdulla et al. 2022: MFPF",
    "MFPF",
    "The main claim holds only in part: three features have the least error in some of the "
    "six cases. Over all cases and ten seeds the colour filter with the same values is ahead. "
    "MFPF is ahead of single-feature filters that lack what the paper's section IV adds.",
    systems.INTERPRETATIONS_NOTE,
    tuple(module.EXPERIMENT for module in _IN_ORDER),
)
