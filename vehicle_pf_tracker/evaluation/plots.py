# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Styles of figures, readable in grey and for colour-blind readers, and stretches to shade."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping
from typing import NamedTuple

from vehicle_pf_tracker.core.truth import Occlusion, Truth


class Style(NamedTuple):
    """Colour, line and marker of one series."""

    colour: str
    line: str | tuple[int, tuple[int, ...]]
    marker: str


# The colours are Okabe and Ito's. Lines tell series apart over time, markers on paths.
LINE_STYLES = (
    Style("#0072B2", "-", "o"),
    Style("#D55E00", "--", "s"),
    Style("#009E73", "-.", "^"),
    Style("#CC79A7", ":", "D"),
    Style("#E69F00", (0, (5, 1, 1, 1, 1, 1)), "v"),
    Style("#56B4E9", (0, (8, 2)), "P"),
)


def stretches(truths: Mapping[int, Truth], kinds: Collection[Occlusion]) -> list[tuple[int, int]]:
    """Return the first and last frames of the stretches with an occlusion of these kinds.

    Truths are given by the number of their frame.
    """
    grouped = itertools.groupby(sorted(truths), lambda number: truths[number].occlusion in kinds)
    found = [list(numbers) for matches, numbers in grouped if matches]
    return [(numbers[0], numbers[-1]) for numbers in found]
