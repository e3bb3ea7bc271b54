# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Where each room stands in their picture: in rows, each above all that it imports from.

Layered drawing after Sugiyama, Tagawa and Toda (1981): rows by the longest chain of imports, long
arrows led through the rows between, and the order in a row by the mean of the neighbours.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from graphlib import TopologicalSorter
from typing import NamedTuple

from tools.rooms import Graph

Point = tuple[float, float]
Bend = tuple[str, str, int]
"""Room at an arrow's tail, room at its head, and the row in which the arrow passes others."""
Entry = str | Bend
"""Entry of a row: a room, or a bend of an arrow that goes on to a lower row."""

BOX_WIDTH = 150.0  # px; the longest name, 19 letters, fits at the font's size
BOX_HEIGHT = 30.0  # px; twice the letters'
BEND_WIDTH = 26.0  # px between an arrow and its neighbours
GAP = 18.0  # px between entries of a row
ROW_STEP = 66.0  # px between rows: a box, and room for the arrows' curves
MARGIN = 12.0  # px around the drawing
SWEEPS = 12  # down and up; the order of these rooms stands still after four


class Layout(NamedTuple):
    """Picture without its strokes.

    Attributes
    ----------
    centres : dict of Entry to Point
        Centre of each room's box and of each bend, px.
    chains : list of list of Entry
        Entries that each arrow passes, from its tail down to its head.
    width, height : float
        Size of the picture, px.
    """

    centres: dict[Entry, Point]
    chains: list[list[Entry]]
    width: float
    height: float


def lay_out(graph: Graph) -> Layout:
    """Place rooms and arrows; the same graph has the same layout.

    Parameters
    ----------
    graph : mapping of str to set of str
        Rooms that each room imports from.
    """
    # 1. A row for each room, and a bend in each row that an arrow passes.
    rows = rows_of(graph)
    # 2. Each arrow as a chain of neighbours.
    chains = [_chain(rows, room, other) for room in sorted(graph) for other in sorted(graph[room])]
    neighbours: dict[Entry, list[Entry]] = {}
    for chain in chains:
        for upper, lower in itertools.pairwise(chain):
            neighbours.setdefault(upper, []).append(lower)
            neighbours.setdefault(lower, []).append(upper)
    # 3. Neighbours above each other: few arrows cross then.
    _order(rows, neighbours)
    # 4. Pixels, with every row in the middle.
    widths = [sum(map(_width, row)) + GAP * (len(row) - 1) for row in rows]
    width = max(widths, default=0.0) + 2 * MARGIN
    height = BOX_HEIGHT + ROW_STEP * (len(rows) - 1) + 2 * MARGIN
    centres: dict[Entry, Point] = {}
    for number, row in enumerate(rows):
        x = (width - widths[number]) / 2
        y = height - MARGIN - BOX_HEIGHT / 2 - ROW_STEP * number
        for entry in row:
            centres[entry] = (x + _width(entry) / 2, y)
            x += _width(entry) + GAP
    return Layout(centres, chains, width, height)


def rows_of(graph: Graph) -> list[list[Entry]]:
    """Return the entries of each row, from the lowest; a bend in each row that an arrow passes.

    Raises
    ------
    ValueError
        If rooms import from each other: none of them can stand above the other.
    """
    level: dict[str, int] = {}
    for room in TopologicalSorter(
        {room: sorted(graph[room]) for room in sorted(graph)}
    ).static_order():
        level[room] = max((level[other] + 1 for other in graph[room]), default=0)
    rows: list[list[Entry]] = [[] for _ in range(max(level.values(), default=-1) + 1)]
    for room in sorted(graph):
        rows[level[room]].append(room)
        for other in sorted(graph[room]):
            for between in range(level[other] + 1, level[room]):
                rows[between].append((room, other, between))
    return rows


def _chain(rows: Sequence[Sequence[Entry]], room: str, other: str) -> list[Entry]:
    """Return the entries that an arrow passes, from its tail down to its head."""
    bends = [(room, other, row) for row in range(len(rows))]
    return [room, *(bend for bend in reversed(bends) if bend in rows[bend[2]]), other]


def _order(rows: list[list[Entry]], neighbours: Mapping[Entry, Sequence[Entry]]) -> None:
    """Order each row in place by the mean position of its neighbours in the row swept before."""
    for sweep in range(2 * SWEEPS):
        numbers = range(len(rows)) if sweep % 2 else range(len(rows) - 1, -1, -1)
        before: dict[Entry, float] = {}
        for number in numbers:
            row = rows[number]
            own = _shares(row)
            wanted = {
                entry: _mean_or(
                    own[entry],
                    [before[beside] for beside in neighbours.get(entry, ()) if beside in before],
                )
                for entry in row
            }
            row.sort(key=wanted.__getitem__)  # stable: entries that want the same stay in order
            before = _shares(row)


def _shares(row: Sequence[Entry]) -> dict[Entry, float]:
    """Return the position of each entry as a share of the row's width.

    Rows of few entries spread like those of many.
    """
    return {entry: (index + 0.5) / len(row) for index, entry in enumerate(row)}


def _mean_or(otherwise: float, values: Sequence[float]) -> float:
    """Return the mean; an entry without neighbours in the other row keeps its position."""
    return sum(values) / len(values) if values else otherwise


def _width(entry: Entry) -> float:
    return BOX_WIDTH if isinstance(entry, str) else BEND_WIDTH
