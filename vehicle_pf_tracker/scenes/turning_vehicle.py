# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A vehicle that turns: sent along any course, and drawn for each heading that it takes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import astuple

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Colour, Sprite
from vehicle_pf_tracker.scenes.courses import Course, Pose
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.solids import SHADOW_OPACITY, Face, draw, extent, normal_of, shadow
from vehicle_pf_tracker.scenes.vehicle_parts import HEAD_LAMP, SILL, TAIL_LAMP

PLATE: Colour = (226, 226, 216)
"""Number plates: nearly white."""
HEADING_STEP = math.radians(2)
"""Sprites are drawn for headings this far apart; their boxes are exact for every heading."""


def all_round(faces: Sequence[Face]) -> list[Face]:
    """Complete a vehicle drawn for the view from its side: the far flank, lamps and plates.

    The result is centred on the ground under the middle of the vehicle.
    """
    x = [point[0] for face in faces for point in face.points]
    width = max(point[1] for face in faces for point in face.points)
    # Flanks lean by 20 degrees at most, so that y of their normal is below -0.9; of roofs, screens
    # and ends it is 0. Any limit between separates them.
    both = [
        half
        for face in faces
        for half in (
            (face, face.moved(lambda x, y, z: (x, width - y, z)))
            # The near flank has a counterpart on the far side, which the view from its side never
            # shows.
            if normal_of(face)[1] < -0.3
            else (face,)
        )
    ]
    middle = (min(x) + max(x)) / 2, width / 2
    faces = (*both, *_ends(min(x), max(x), width))
    return [face.moved(lambda x, y, z: (x - middle[0], y - middle[1], z)) for face in faces]


def turned(faces: Iterable[Face], heading: float) -> list[Face]:
    """Turn a solid by `heading` (rad): 0 drives to the right, pi/2 away from the viewer."""
    cosine = math.cos(heading)
    sine = math.sin(heading)
    return [
        face.moved(lambda x, y, z: (x * cosine - y * sine, x * sine + y * cosine, z))
        for face in faces
    ]


def _ends(rear: float, front: float, width: float) -> list[Face]:
    """Lamps, bumper and number plate on front and rear."""
    # 2 cm outside of the body, so that they are nearer to the viewer than the face they are on.
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


class TurningVehicle:
    """A vehicle that can be sent along any course.

    Parameters
    ----------
    faces : sequence of Face
        The vehicle as seen from its near side.
    scale : float
        The largest scale it will be seen at, px per metre: sets how finely it is drawn.
    """

    def __init__(self, faces: Sequence[Face], scale: float) -> None:
        self._faces = all_round(faces)
        self._scale = scale
        self._sprites: dict[tuple[int, bool], Sprite] = {}
        self._extents: dict[tuple[float, bool], Box] = {}

    @property
    def size(self) -> tuple[float, float]:
        """Width and height (px) at heading 0 and the scale it is drawn for."""
        bounds = self._extent(0.0, shade=False)
        return bounds.width * self._scale, bounds.height * self._scale

    def on(self, course: Course) -> tuple[Actor, Actor]:
        """Send it along `course`; returns shadow and body, in the order to paint them."""
        return self._actor(course, shade=True), self._actor(course, shade=False)

    def _actor(self, course: Course, *, shade: bool) -> Actor:
        def look(frame: float) -> Sprite:
            return self._sprite(course(frame).heading, shade=shade)

        def path(frame: float) -> Box:
            return self._box(course(frame), shade=shade)

        return Actor(look, path, hides=not shade)

    def _box(self, pose: Pose, *, shade: bool) -> Box:
        left, top, *size = (
            pose.scale * side for side in astuple(self._extent(pose.heading, shade=shade))
        )
        return Box(pose.x + left, pose.y + top, *size)

    def _sprite(self, heading: float, *, shade: bool) -> Sprite:
        # By the rounded heading: a quarter turn needs 45 sprites, however many frames it has.
        key = round(heading / HEADING_STEP), shade
        if key not in self._sprites:
            # Drawn for the rounded heading; the box, and with it the truth, is that of the exact
            # one.
            faces = turned(self._faces, key[0] * HEADING_STEP)
            faces = shadow(faces) if shade else faces
            bounds = extent(faces)
            size = bounds.width * self._scale, bounds.height * self._scale
            self._sprites[key] = draw(faces, *size, SHADOW_OPACITY if shade else 1.0)
        return self._sprites[key]

    def _extent(self, heading: float, *, shade: bool) -> Box:
        """Tight box in metres around the point on the ground under the vehicle's middle."""
        key = heading, shade
        if key not in self._extents:
            faces = turned(self._faces, heading)
            self._extents[key] = extent(shadow(faces) if shade else faces)
        return self._extents[key]
