# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles of ordinary sizes as solids of coloured faces: cars, vans, lorries and a coach."""

from __future__ import annotations

from vehicle_pf_tracker.scenes.compositing import Colour
from vehicle_pf_tracker.scenes.solids import Face, side_panel, strips
from vehicle_pf_tracker.scenes.vehicle_parts import (
    HEAD_LAMP,
    RIM,
    SCREEN,
    SIDE_GLASS,
    SILL,
    TAIL_LAMP,
    cabin_faces,
    flank,
    lamps,
    panel,
    side_window,
    tinted,
    wheels,
)

ROOF_UNIT: Colour = (170, 172, 174)
"""Air conditioning of a coach."""


def car(paint: Colour) -> list[Face]:
    """Build a small hatchback, 3.7 m long, with a dark glass roof."""
    body = [
        (0.0, 0.32),
        (0.0, 0.78),
        (0.12, 0.95),
        (2.55, 0.95),
        (3.4, 0.8),
        (3.66, 0.62),
        (3.7, 0.32),
    ]
    cabin = [(0.1, 0.95), (0.42, 1.5), (1.95, 1.5), (2.65, 0.95)]
    # In the roof's own plane: of faces in one place the later is seen.
    roof_window = strips([(0.75, 1.5), (1.65, 1.5)], 0.45, 1.25, (62, 66, 74))
    windows = [
        [(0.5, 1.0), (0.66, 1.4), (1.15, 1.43), (1.15, 1.0)],
        [(1.25, 1.0), (1.25, 1.43), (1.9, 1.4), (2.35, 1.0)],
    ]
    return [
        *strips(body, 0, 1.68, paint),
        *cabin_faces(cabin, 1.68, paint),
        *roof_window,
        *(side_window(window) for window in windows),
        *flank(body, paint, door=1.2),
        *lamps(body, front=3.7, rear=0.0),
        *wheels((0.68, 2.95), 0.31),
    ]


def saloon(paint: Colour) -> list[Face]:
    """Build a saloon, 4.6 m long, with its boot behind the cabin."""
    body = [
        (0.0, 0.35),
        (0.0, 0.86),
        (0.1, 0.97),
        (3.3, 0.94),
        (4.35, 0.78),
        (4.58, 0.6),
        (4.6, 0.32),
    ]
    cabin = [(0.6, 0.96), (1.25, 1.44), (2.6, 1.44), (3.4, 0.94)]
    windows = [
        [(0.95, 1.0), (1.35, 1.37), (1.9, 1.38), (1.9, 1.0)],
        [(2.0, 1.0), (2.0, 1.38), (2.55, 1.37), (3.05, 1.0)],
    ]
    return [
        *strips(body, 0, 1.78, paint),
        *cabin_faces(cabin, 1.78, paint),
        *(side_window(window) for window in windows),
        *flank(body, paint, door=1.95),
        *lamps(body, front=4.6, rear=0.0),
        *wheels((0.85, 3.7), 0.32),
    ]


def van(paint: Colour) -> list[Face]:
    """Build a panel van, 5.4 m long, with windows in the cab only."""
    body = [
        (0.0, 0.4),
        (0.0, 2.25),
        (0.08, 2.4),
        (3.5, 2.45),
        (3.9, 2.3),
        (4.6, 1.35),
        (5.3, 1.1),
        (5.4, 0.4),
    ]
    width = 2.0
    screen = Face(((3.9, 0.1, 2.3), (4.6, 0.05, 1.35), (4.6, 1.95, 1.35), (3.9, 1.9, 2.3)), SCREEN)
    door_window = side_panel([(3.45, 1.4), (3.45, 2.05), (3.85, 2.05), (4.35, 1.4)], 0, SIDE_GLASS)
    return [
        *strips(body, 0, width, paint),
        screen,
        *flank(body, paint, door=3.35),
        door_window,
        *lamps(body, front=5.4, rear=0.0),
        *wheels((1.0, 4.5), 0.36),
    ]


def suv(paint: Colour) -> list[Face]:
    """Build a sport utility vehicle, 4.5 m long, tall and square, with dark cladding."""
    body = [
        (0.0, 0.45),
        (0.0, 1.0),
        (0.1, 1.12),
        (3.1, 1.12),
        (4.25, 1.02),
        (4.47, 0.85),
        (4.5, 0.42),
    ]
    cabin = [(0.05, 1.12), (0.3, 1.82), (2.45, 1.82), (3.15, 1.12)]
    windows = [
        [(0.4, 1.2), (0.5, 1.72), (1.0, 1.73), (1.0, 1.2)],
        [(1.1, 1.2), (1.1, 1.73), (1.8, 1.73), (1.8, 1.2)],
        [(1.9, 1.2), (1.9, 1.73), (2.35, 1.72), (2.8, 1.2)],
    ]
    return [
        *strips(body, 0, 1.88, paint),
        *cabin_faces(cabin, 1.88, paint),
        *(
            side_panel([(0.4, 1.82), (0.4, 1.88), (2.3, 1.88), (2.3, 1.82)], y, RIM)
            for y in (1.6, 0.28)
        ),
        *(side_window(window) for window in windows),
        *flank(body, paint, door=1.85),
        panel((0.05, 4.45), (0.4, 0.62), SILL),
        *lamps(body, front=4.5, rear=0.0),
        *wheels((0.9, 3.6), 0.38),
    ]


def lorry(cab: Colour, box: Colour, stripe: Colour) -> list[Face]:
    """Build a box lorry, 10.6 m long: a box of 8.3 m, without an end wall, behind a cab."""
    width = 2.5
    floor = 1.1
    top = 4.0
    load = [(0.0, floor), (0.0, top), (8.3, top), (8.3, floor)]
    tractor = [(8.4, 0.7), (8.4, 3.8), (9.1, 3.7), (10.2, 2.9), (10.55, 1.9), (10.6, 0.7)]
    screen = Face(
        ((10.15, 0.15, 2.85), (10.52, 0.15, 1.95), (10.52, 2.35, 1.95), (10.15, 2.35, 2.85)), SCREEN
    )
    return [
        # The frame, 0.3 m inside of the flank: it is seen below the box and between the wheels.
        side_panel([(0.1, 0.6), (0.1, 1.2), (10.4, 1.2), (10.4, 0.6)], 0.3, SILL),
        *strips(tractor, 0, width, cab),
        screen,
        side_panel(tractor, 0, cab),
        side_panel([(9.1, 1.9), (9.1, 2.75), (9.9, 2.75), (10.25, 1.9)], 0, SIDE_GLASS),
        # Without the end walls of the box, which the view from the side never shows.
        *strips(load[1:3], 0, width, box),
        side_panel(load, 0, box),
        panel((0.0, 8.3), (2.0, 2.5), stripe),
        *(panel((x, x + 0.06), (1.15, 3.95), SILL) for x in (0.02, 8.2)),
        panel((2.9, 6.0), (0.5, 1.05), (120, 122, 124)),
        side_panel([(10.3, 0.8), (10.3, 1.1), (10.58, 1.1), (10.6, 0.8)], 0, HEAD_LAMP, glow=True),
        panel((0.0, 0.3), (0.8, 1.05), TAIL_LAMP, glow=True),
        *wheels((1.0, 2.2, 7.1, 9.4), 0.5),
    ]


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
        panel((0.0, 4.2), (0.8, 1.0), tinted(box, 0.7)),
        panel((0.7, 3.5), (1.5, 2.2), tinted(cab, 0.9)),
        *lamps(front, front=5.98, rear=0.0),
        *wheels((1.0, 5.0), 0.42),
    ]


def coach(paint: Colour, stripe: Colour, length: float = 12.0) -> list[Face]:
    """Build a coach, 3.75 m high and `length` m long, with a row of dark windows over a hold."""
    width = 2.5
    top = 3.75
    body = [
        (0.0, 0.4),
        (0.0, top - 0.1),
        (0.15, top),
        (length - 0.3, top),
        (length - 0.05, top - 0.3),
        (length, 0.4),
    ]
    # Panes of about 1.5 m, as many as fit whatever the length.
    count = round((length - 1.0) / 1.5)
    pane = (length - 0.9) / count
    return [
        *strips(body, 0, width, paint),
        *strips([(length - 0.04, top - 0.4), (length - 0.01, 1.3)], 0.15, width - 0.15, SCREEN),
        side_panel(body, 0, paint),
        panel((0.0, length), (1.3, 1.7), stripe),
        *(
            panel((x, x + pane - 0.12), (2.0, 3.25), SIDE_GLASS)
            for x in (0.45 + pane * number for number in range(count))
        ),
        *(panel((x, x + 0.95), (0.5, 3.2), SCREEN) for x in (length - 1.5, length * 0.52)),
        *strips([(length * 0.3, top + 0.1), (length * 0.45, top + 0.1)], 0.6, 1.9, ROOF_UNIT),
        *lamps([*body[:-2], (length - 0.05, 1.0), (length, 0.4)], front=length, rear=0.0),
        *wheels((2.2, length - 2.7), 0.48),
    ]
