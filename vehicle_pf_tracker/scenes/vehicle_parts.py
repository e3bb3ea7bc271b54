# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts that most vehicles have, as faces: flanks, cabins, windows, lamps and wheels."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_pf_tracker.scenes.compositing import Colour
from vehicle_pf_tracker.scenes.solids import Face, Point, disc, side_panel

TYRE: Colour = (22, 22, 24)
"""Rubber."""
RIM: Colour = (150, 152, 156)
"""Aluminium of wheels."""
SILL: Colour = (38, 38, 40)
"""Plastic of sills and bumpers."""
SIDE_GLASS: Colour = (40, 48, 56)
"""Side windows, which show the dark inside."""
SCREEN: Colour = (92, 112, 128)
"""Windscreens, which lean and reflect the sky."""
HEAD_LAMP: Colour = (244, 240, 214)
"""Glass of head lamps."""
TAIL_LAMP: Colour = (186, 24, 22)
"""Glass of tail lamps."""
AMBER_LAMP: Colour = (236, 140, 30)
"""Glass of indicators."""
Contour = Sequence[tuple[float, float]]
"""Points (x, z) in m, x from the rear and z from the ground, over the top from rear to front."""
_TUMBLEHOME = 0.2
"""Inward lean of the cabin from sill to roof, m: 20 degrees on a cabin of 0.55 m, a choice."""


def panel(
    x: tuple[float, float], z: tuple[float, float], colour: Colour, *, glow: bool = False
) -> Face:
    """Make an upright rectangle on the near side."""
    rear, front = x
    low, high = z
    contour = [(rear, low), (rear, high), (front, high), (front, low)]
    return side_panel(contour, 0, colour, glow=glow)


def tinted(paint: Colour, light: float) -> Colour:
    """Return `paint` made `light` times as bright."""
    red, green, blue = paint
    return red * light, green * light, blue * light


def flank(body: Contour, paint: Colour, door: float) -> list[Face]:
    """Near side of the body: paint, a darker lower part, the sill and the gap of a door."""
    rear = body[0][0]
    front = body[-1][0]
    return [
        # Parts of other brightness: a side of one colour has no edges within its outline.
        side_panel(body, 0, paint),
        panel((rear, front), (0.3, 0.55), tinted(paint, 0.8)),
        panel((rear + 0.3, front - 0.3), (0.22, 0.36), SILL),
        panel((door, door + 0.05), (0.4, 0.95), SILL),
    ]


def cabin_faces(cabin: Contour, width: float, paint: Colour) -> list[Face]:
    """Rear and front screens, roof and the painted near side of a cabin of four (x, z) points."""
    (xr, zr), (x1, z1), (x2, z2), (xf, zf) = cabin
    near = _TUMBLEHOME
    far = width - _TUMBLEHOME
    return [
        Face(((xr, 0.05, zr), (x1, near, z1), (x1, far, z1), (xr, width - 0.05, zr)), SCREEN),
        Face(((xf, 0.05, zf), (x2, near, z2), (x2, far, z2), (xf, width - 0.05, zf)), SCREEN),
        Face(((x1, near, z1), (x2, near, z2), (x2, far, z2), (x1, far, z1)), paint),
        Face(((xr, 0.0, zr), (x1, near, z1), (x2, near, z2), (xf, 0.0, zf)), paint),
    ]


def side_window(window: Contour) -> Face:
    """Glass in the leaning near side of a cabin from sill (0.95 m) to roof (1.5 m)."""
    points: list[Point] = [(x, _TUMBLEHOME * (z - 0.95) / 0.55, z) for x, z in window]
    return Face(tuple(points), SIDE_GLASS)


def lamps(body: Contour, front: float, rear: float) -> list[Face]:
    """Head lamp, amber side lamp and tail lamp, on the near side."""
    # Head lamps end at the edge of the bonnet, the last corner but one.
    top = body[-2][1]
    return [
        side_panel(
            [
                (front - 0.42, top - 0.14),
                (front - 0.42, top),
                (front - 0.02, top),
                (front, top - 0.14),
            ],
            0,
            HEAD_LAMP,
            glow=True,
        ),
        panel((front - 0.55, front - 0.42), (top - 0.14, top), AMBER_LAMP, glow=True),
        panel((rear, rear + 0.22), (0.6, 0.85), TAIL_LAMP, glow=True),
    ]


def wheels(axles: Sequence[float], radius: float) -> list[Face]:
    """Wheels of `radius` (m) on the near side, in dark wheel arches."""
    # Concentric, the largest first: of faces in one place the later is seen.
    return [
        face
        for x in axles
        for face in (
            disc(x, radius + 0.04, radius + 0.09, SILL),
            disc(x, radius, radius, TYRE),
            disc(x, radius, 0.55 * radius, RIM),
        )
    ]
