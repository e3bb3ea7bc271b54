"""What lorries, trucks and coaches look like."""

from __future__ import annotations

from vehicle_pf_tracker.scenes.compositing import Colour
from vehicle_pf_tracker.scenes.solids import Face, side_panel, strips
from vehicle_pf_tracker.scenes.vehicles import (
    HEAD_LAMP,
    SCREEN,
    SIDE_GLASS,
    SILL,
    TAIL_LAMP,
    lamps,
    tinted,
    wheels,
)

ROOF_UNIT: Colour = (170, 172, 174)


def lorry(cab: Colour, box: Colour, stripe: Colour) -> list[Face]:
    """Build a box lorry, 10.6 m long: a box of 8.3 m, without an end wall, behind a cab."""
    width, floor, top = 2.5, 1.1, 4.0
    load = [(0.0, floor), (0.0, top), (8.3, top), (8.3, floor)]
    tractor = [(8.4, 0.7), (8.4, 3.8), (9.1, 3.7), (10.2, 2.9), (10.55, 1.9), (10.6, 0.7)]
    screen = Face(((10.15, 0.15, 2.85), (10.52, 0.15, 1.95), (10.52, 2.35, 1.95),
                   (10.15, 2.35, 2.85)), SCREEN)  # fmt: skip
    return [
        side_panel([(0.1, 0.6), (0.1, 1.2), (10.4, 1.2), (10.4, 0.6)], 0.3, SILL),
        *strips(tractor, 0, width, cab),
        screen,
        side_panel(tractor, 0, cab),
        side_panel([(9.1, 1.9), (9.1, 2.75), (9.9, 2.75), (10.25, 1.9)], 0, SIDE_GLASS),
        *strips(load[1:3], 0, width, box),
        side_panel(load, 0, box),
        side_panel([(0.0, 2.0), (0.0, 2.5), (8.3, 2.5), (8.3, 2.0)], 0, stripe),
        *(side_panel([(x, 1.15), (x, 3.95), (x + 0.06, 3.95), (x + 0.06, 1.15)], 0, SILL)
          for x in (0.02, 8.2)),
        side_panel([(2.9, 0.5), (2.9, 1.05), (6.0, 1.05), (6.0, 0.5)], 0, (120, 122, 124)),
        side_panel([(10.3, 0.8), (10.3, 1.1), (10.58, 1.1), (10.6, 0.8)], 0, HEAD_LAMP, glow=True),
        side_panel([(0.0, 0.8), (0.0, 1.05), (0.3, 1.05), (0.3, 0.8)], 0, TAIL_LAMP, glow=True),
        *wheels((1.0, 2.2, 7.1, 9.4), 0.5),
    ]  # fmt: skip


def truck(cab: Colour, box: Colour) -> list[Face]:
    """Build a small box truck, 6 m long: a box of 4.2 m behind a cab-over cab."""
    width = 2.1
    load = [(0.0, 0.8), (0.0, 2.9), (4.2, 2.9), (4.2, 0.8)]
    front = [(4.3, 0.5), (4.3, 2.2), (4.6, 2.3), (5.3, 2.2), (5.9, 1.35), (6.0, 0.5)]
    return [
        side_panel([(0.1, 0.5), (0.1, 0.9), (4.4, 0.9), (4.4, 0.5)], 0.3, SILL),
        *strips(front, 0, width, cab),
        *strips([(5.36, 2.12), (5.86, 1.4)], 0.15, width - 0.15, SCREEN),
        side_panel(front, 0, cab),
        side_panel([(4.7, 1.4), (4.7, 2.0), (5.2, 2.0), (5.65, 1.4)], 0, SIDE_GLASS),
        *strips(load, 0, width, box),
        side_panel(load, 0, box),
        side_panel([(0.0, 0.8), (0.0, 1.0), (4.2, 1.0), (4.2, 0.8)], 0, tinted(box, 0.7)),
        side_panel([(0.7, 1.5), (0.7, 2.2), (3.5, 2.2), (3.5, 1.5)], 0, tinted(cab, 0.9)),
        *lamps(front, front=5.98, rear=0.0),
        *wheels((1.0, 5.0), 0.42),
    ]


def coach(paint: Colour, stripe: Colour, length: float = 12.0) -> list[Face]:
    """Build a coach, 3.75 m high and `length` m long, with a row of dark windows over a hold."""
    width, top = 2.5, 3.75
    body = [(0.0, 0.4), (0.0, top - 0.1), (0.15, top), (length - 0.3, top),
            (length - 0.05, top - 0.3), (length, 0.4)]  # fmt: skip
    count = round((length - 1.0) / 1.5)
    pane = (length - 0.9) / count
    return [
        *strips(body, 0, width, paint),
        *strips([(length - 0.04, top - 0.4), (length - 0.01, 1.3)], 0.15, width - 0.15, SCREEN),
        side_panel(body, 0, paint),
        side_panel([(0.0, 1.3), (0.0, 1.7), (length, 1.7), (length, 1.3)], 0, stripe),
        *(side_panel([(x, 2.0), (x, 3.25), (x + pane - 0.12, 3.25), (x + pane - 0.12, 2.0)], 0,
                     SIDE_GLASS)
          for x in (0.45 + pane * number for number in range(count))),
        *(side_panel([(x, 0.5), (x, 3.2), (x + 0.95, 3.2), (x + 0.95, 0.5)], 0, SCREEN)
          for x in (length - 1.5, length * 0.52)),
        *strips([(length * 0.3, top + 0.1), (length * 0.45, top + 0.1)], 0.6, 1.9, ROOF_UNIT),
        *lamps([*body[:-2], (length - 0.05, 1.0), (length, 0.4)], front=length, rear=0.0),
        *wheels((2.2, length - 2.7), 0.48),
    ]  # fmt: skip
