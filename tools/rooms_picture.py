# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The picture of the rooms as an SVG: a box for each, and an arrow for each import."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from xml.sax.saxutils import escape

from tools.rooms import Graph
from tools.rooms_layout import BOX_HEIGHT, BOX_WIDTH, ROW_STEP, Point, lay_out

_HEAD = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w:g} {h:g}" width="{w:g}" \
height="{h:g}" font-family="sans-serif" font-size="14" text-anchor="middle">
<title>Rooms of the package; an arrow leads to what a room imports from</title>
<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" \
orient="auto"><path d="M0 0 8 4 0 8z" fill="#455a64"/></marker></defs>
<rect width="100%" height="100%" fill="#ffffff"/>
"""


def picture(graph: Graph) -> str:
    """Return the SVG of the graph; the same graph has the same text.

    Parameters
    ----------
    graph : mapping of str to set of str
        Rooms that each room imports from.
    """
    layout = lay_out(graph)
    lines = [_arrow([layout.centres[entry] for entry in chain]) for chain in layout.chains]
    lines += [_box(room, layout.centres[room]) for room in sorted(graph)]
    head = _HEAD.format(w=layout.width, h=layout.height)
    return head + "\n".join([*lines, "</svg>"]) + "\n"


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


def _box(room: str, centre: Point) -> str:
    x = centre[0] - BOX_WIDTH / 2
    y = centre[1] - BOX_HEIGHT / 2
    return (
        f'<rect x="{x:g}" y="{y:g}" width="{BOX_WIDTH:g}" height="{BOX_HEIGHT:g}" rx="4" '
        f'fill="#eceff1" stroke="#455a64"/>'
        f'<text x="{centre[0]:g}" y="{centre[1] + 5:g}">{escape(room)}</text>'
    )
