"""Vehicles that turn: both flanks and both ends of a solid, and the solid at any heading."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from vehicle_pf_tracker.scenes.compositing import Colour
from vehicle_pf_tracker.scenes.solids import Face, Point, normal_of
from vehicle_pf_tracker.scenes.vehicles import HEAD_LAMP, SILL, TAIL_LAMP

PLATE: Colour = (226, 226, 216)


def all_round(faces: Sequence[Face]) -> list[Face]:
    """Complete a vehicle drawn for the view from its side: the far flank, lamps and plates.

    The result is centred on the ground under the middle of the vehicle.
    """
    x = [point[0] for face in faces for point in face.points]
    width = max(point[1] for face in faces for point in face.points)
    both = [
        half
        for face in faces
        for half in ((face, _reflected(face, width)) if normal_of(face)[1] < -0.3 else (face,))
    ]
    middle = (min(x) + max(x)) / 2, width / 2
    return [
        Face(tuple((px - middle[0], py - middle[1], pz) for px, py, pz in face.points),
             face.colour, face.glow)
        for face in (*both, *_ends(min(x), max(x), width))
    ]  # fmt: skip


def turned(faces: Iterable[Face], heading: float) -> list[Face]:
    """Turn a solid by `heading` (rad): 0 drives to the right, pi/2 away from the viewer."""
    cosine, sine = math.cos(heading), math.sin(heading)

    def moved(point: Point) -> Point:
        x, y, z = point
        return x * cosine - y * sine, x * sine + y * cosine, z

    return [Face(tuple(map(moved, face.points)), face.colour, face.glow) for face in faces]


def _reflected(face: Face, width: float) -> Face:
    return Face(tuple((x, width - y, z) for x, y, z in face.points), face.colour, face.glow)


def _ends(rear: float, front: float, width: float) -> list[Face]:
    """Lamps, bumper and number plate on front and rear."""
    faces = []
    for x, lamp in ((rear - 0.02, TAIL_LAMP), (front + 0.02, HEAD_LAMP)):
        faces.append(_upright(x, (0.1, width - 0.1), (0.3, 0.4), SILL))
        faces.append(_upright(x, (width / 2 - 0.26, width / 2 + 0.26), (0.4, 0.5), PLATE))
        faces += [
            _upright(x, (left, left + 0.35), (0.46, 0.6), lamp) for left in (0.1, width - 0.45)
        ]
    return faces


def _upright(x: float, y: tuple[float, float], z: tuple[float, float], colour: Colour) -> Face:
    corners = ((x, y[0], z[0]), (x, y[0], z[1]), (x, y[1], z[1]), (x, y[1], z[0]))
    return Face(corners, colour, glow=True)
