# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Styles of series in figures, readable in grey and for colour-blind readers."""

from __future__ import annotations

from typing import NamedTuple


class Style(NamedTuple):
    """Colour, line and marker of one series."""

    colour: str
    line: str | tuple[int, tuple[int, ...]]
    marker: str


# The colours are Okabe and Ito's. Lines distinguish series over time, markers on paths.
LINE_STYLES = (
    Style("#0072B2", "-", "o"),
    Style("#D55E00", "--", "s"),
    Style("#009E73", "-.", "^"),
    Style("#CC79A7", ":", "D"),
    Style("#E69F00", (0, (5, 1, 1, 1, 1, 1)), "v"),
    Style("#56B4E9", (0, (8, 2)), "P"),
)
