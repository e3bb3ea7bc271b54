# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The picture of the rooms: boxes in rows, each above all that it imports from, as an SVG.

Layered drawing after Sugiyama, Tagawa and Toda (1981): rows by the longest chain of imports, long
arrows led through the rows between, and the order in a row by the mean of the neighbours.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from graphlib import TopologicalSorter
from xml.sax.saxutils import escape

Graph = Mapping[str, set[str]]
Point = tuple[float, float]
Bend = tuple[str, str, int]
"""Room at an arrow's tail, room at its head, and the row in which the arrow passes others."""
Entry = str | Bend
"""Entry of a row: a room, or a bend of an arrow that goes on to a lower row."""

BOX_WIDTH = 132.0  # px; the longest name, 16 letters, fits at the font's size
BOX_HEIGHT = 30.0  # px; twice the letters'
BEND_WIDTH = 26.0  # px between an arrow and its neighbours
GAP = 18.0  # px between entries of a row
ROW_STEP = 66.0  # px between rows: a box, and room for the arrows' curves
MARGIN = 12.0  # px around the drawing
SWEEPS = 12  # down and up; the order of these rooms stands still after four

_HEAD = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w:g} {h:g}" width="{w:g}" \
height="{h:g}" font-family="sans-serif" font-size="14" text-anchor="middle">
<title>Rooms of the package; an arrow leads to what a room imports from</title>
<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" \
orient="auto"><path d="M0 0 8 4 0 8z" fill="#455a64"/></marker></defs>
<rect width="100%" height="100%" fill="#ffffff"/>
"""


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


def picture(graph: Graph) -> str:
    """Return the SVG of the graph; the same graph has the same text.

    Parameters
    ----------
    graph : mapping of str to set of str
        Rooms that each room imports from.
    """
    rows = rows_of(graph)
    chains = [_chain(rows, room, other) for room in sorted(graph) for other in sorted(graph[room])]
    neighbours: dict[Entry, list[Entry]] = {}
    for chain in chains:
        for upper, lower in itertools.pairwise(chain):
            neighbours.setdefault(upper, []).append(lower)
            neighbours.setdefault(lower, []).append(upper)
    _order(rows, neighbours)
    places, width, height = _places(rows)
    lines = [_arrow([places[entry] for entry in chain]) for chain in chains]
    lines += [_box(room, places[room]) for room in sorted(graph)]
    return _HEAD.format(w=width, h=height) + "\n".join([*lines, "</svg>"]) + "\n"


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
            # Shares of the row's width: rows of few entries spread like those of many.
            own = {entry: (index + 0.5) / len(row) for index, entry in enumerate(row)}
            means = {
                entry: _mean(
                    [before[beside] for beside in neighbours.get(entry, ()) if beside in before]
                )
                for entry in row
            }
            # What has no neighbour there keeps its position; `sort` is stable, so ties do too.
            row.sort(key=lambda entry: _or(means[entry], own[entry]))
            before = {entry: (index + 0.5) / len(row) for index, entry in enumerate(row)}


def _mean(values: Sequence[float]) -> float | None:
    return sum(values) / len(values) if values else None


def _or(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value


def _places(rows: Sequence[Sequence[Entry]]) -> tuple[dict[Entry, Point], float, float]:
    """Return the centre of each entry, and the width and height of the whole, px."""
    widths = [sum(map(_width, row)) + GAP * (len(row) - 1) for row in rows]
    width = max(widths, default=0.0) + 2 * MARGIN
    height = BOX_HEIGHT + ROW_STEP * (len(rows) - 1) + 2 * MARGIN
    places: dict[Entry, Point] = {}
    for number, row in enumerate(rows):
        x = (width - widths[number]) / 2
        y = height - MARGIN - BOX_HEIGHT / 2 - ROW_STEP * number
        for entry in row:
            places[entry] = (x + _width(entry) / 2, y)
            x += _width(entry) + GAP
    return places, width, height


def _width(entry: Entry) -> float:
    return BOX_WIDTH if isinstance(entry, str) else BEND_WIDTH


def _arrow(points: Sequence[Point]) -> str:
    """Draw from the lower edge of the first box to the upper edge of the last, upright at bends."""
    half = BOX_HEIGHT / 2
    parts = [f"M{points[0][0]:g} {points[0][1] + half:g}"]
    for (before, _), (x, y) in itertools.pairwise(points):
        # A bend is as high as a box, and straight there: no curve touches the boxes beside it.
        middle = y - ROW_STEP / 2
        parts.append(f"C{before:g} {middle:g} {x:g} {middle:g} {x:g} {y - half:g}")
        parts.append(f"V{y + half:g}")
    drawn = "".join(parts[:-1])  # the last one is a box, and not a bend
    return f'<path d="{drawn}" fill="none" stroke="#455a64" marker-end="url(#tip)"/>'


def _box(room: str, place: Point) -> str:
    x = place[0] - BOX_WIDTH / 2
    y = place[1] - BOX_HEIGHT / 2
    return (
        f'<rect x="{x:g}" y="{y:g}" width="{BOX_WIDTH:g}" height="{BOX_HEIGHT:g}" rx="4" '
        f'fill="#eceff1" stroke="#455a64"/>'
        f'<text x="{place[0]:g}" y="{place[1] + 5:g}">{escape(room)}</text>'
    )
