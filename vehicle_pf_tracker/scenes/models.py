# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that turn, and the ways things take through the frames.

Paths give boxes in the image, courses the poses of vehicles on the ground.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import astuple, dataclass, replace
from itertools import pairwise
from typing import TypeAlias, TypeVar

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Colour, Sprite
from vehicle_pf_tracker.scenes.scene import Actor, Path
from vehicle_pf_tracker.scenes.solids import ELEVATION, Face, draw, extent, normal_of, shadow
from vehicle_pf_tracker.scenes.vehicles import HEAD_LAMP, SILL, TAIL_LAMP

PLATE: Colour = (226, 226, 216)
SHADOW_OPACITY = 0.5
HEADING_STEP = math.radians(2)
"""Sprites are drawn for headings this far apart; their boxes are exact for every heading."""


def standing(box: Box) -> Path:
    """Return the path of what stands for ever in `box`."""
    return lambda _: box


def moving(start: Box, speed: float) -> Path:
    """Return the path from `start`, the box in frame 0, along x with `speed` (px/frame)."""
    return lambda frame: Box(start.x + speed * frame, start.y, start.width, start.height)


Wave: TypeAlias = Callable[[float], float]
"""A displacement, px, by frame number."""


def wave(amplitude: float, period: float, phase: float) -> Wave:
    """Return a slow swing: `amplitude` (px), `period` (frames) and `phase` (rad)."""
    return lambda frame: amplitude * math.sin(2 * math.pi * frame / period + phase)


@dataclass(frozen=True, slots=True)
class Pose:
    """A position on the ground, and the heading of a vehicle there.

    Attributes
    ----------
    x, y : float
        The point on the stage under the vehicle's middle, px.
    heading : float
        0 to the right, pi/2 away from the viewer, rad.
    scale : float
        Size there, px per metre.
    """

    x: float
    y: float
    heading: float
    scale: float


Placed = TypeVar("Placed", Box, Pose)
Course: TypeAlias = Callable[[float], Pose]
"""Gives the pose of a vehicle at a frame number, counted from 0."""


@dataclass(frozen=True, slots=True)
class Pace:
    """A speed that changes linearly between `knots` (frame, px/frame), constant outside them."""

    knots: tuple[tuple[float, float], ...]

    @classmethod
    def steady(cls, speed: float) -> Pace:
        """Make the pace of one `speed` (px/frame)."""
        return cls(((0.0, speed),))

    def __call__(self, frame: float) -> float:
        """Give the distance covered from the first knot to `frame`, px."""
        (start, speed), (end, last_speed) = self.knots[0], self.knots[-1]
        distance = speed * min(frame - start, 0.0) + last_speed * max(frame - end, 0.0)
        for (t0, v0), (t1, v1) in pairwise(self.knots):
            spent = min(max(frame, t0), t1) - t0
            distance += v0 * spent + (v1 - v0) * spent**2 / (2 * (t1 - t0))
        return distance

    def arrival(self, distance: float) -> float:
        """Give the frame in which `distance` (px, at least 0) is covered, for speeds over 0."""
        low, high = self.knots[0][0], self.knots[0][0] + 1.0
        while self(high) < distance:
            high += high - low
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if self(middle) < distance else (low, middle)
        return high


def straight(start: Pose, pace: Pace) -> Course:
    """Return the course that goes straight on from `start`, as flat ground looks."""
    east = math.cos(start.heading)
    north = math.sin(start.heading)

    def course(frame: float) -> Pose:
        gone = pace(frame)
        y = start.y - gone * north * math.sin(ELEVATION)
        return replace(start, x=start.x + gone * east, y=y)

    return course


def swaying(
    course: Callable[[float], Placed], surge: Wave, weave: Wave
) -> Callable[[float], Placed]:
    """Follow a path or a course as a human drives: `surge` along x, `weave` along y."""

    def swayed(frame: float) -> Placed:
        placed = course(frame)
        return replace(placed, x=placed.x + surge(frame), y=placed.y + weave(frame))

    return swayed


def all_round(faces: Sequence[Face]) -> list[Face]:
    """Complete a vehicle drawn for the view from its side: the far flank, lamps and plates.

    The result is centred on the ground under the middle of the vehicle.
    """
    x = [point[0] for face in faces for point in face.points]
    width = max(point[1] for face in faces for point in face.points)
    both = [
        half
        for face in faces
        for half in (
            (face, face.moved(lambda x, y, z: (x, width - y, z)))
            if normal_of(face)[1] < -0.3
            else (face,)
        )
    ]
    middle = (min(x) + max(x)) / 2, width / 2
    faces = (*both, *_ends(min(x), max(x), width))
    return [face.moved(lambda x, y, z: (x - middle[0], y - middle[1], z)) for face in faces]


def turned(faces: Iterable[Face], heading: float) -> list[Face]:
    """Turn a solid by `heading` (rad): 0 drives to the right, pi/2 away from the viewer."""
    cosine, sine = math.cos(heading), math.sin(heading)
    return [
        face.moved(lambda x, y, z: (x * cosine - y * sine, x * sine + y * cosine, z))
        for face in faces
    ]


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


class Model:
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
        key = round(heading / HEADING_STEP), shade
        if key not in self._sprites:
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
