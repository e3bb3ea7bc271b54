# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Paths of boxes in the image, and courses of vehicles on the ground, over time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias, TypeVar

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.scene import Path
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION


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
        """Return the distance covered from the first knot to `frame`, px."""
        start, speed = self.knots[0]
        end, last_speed = self.knots[-1]
        # Outside of the knots; before the first the distance is negative, so that a pace may begin
        # at any frame of a scene.
        distance = speed * min(frame - start, 0.0) + last_speed * max(frame - end, 0.0)
        for (t0, v0), (t1, v1) in pairwise(self.knots):
            spent = min(max(frame, t0), t1) - t0
            # Area under a speed that changes linearly.
            distance += v0 * spent + (v1 - v0) * spent**2 / (2 * (t1 - t0))
        return distance

    def arrival(self, distance: float) -> float:
        """Return the frame in which `distance` (px, at least 0) is covered, for speeds over 0."""
        low = self.knots[0][0]
        high = self.knots[0][0] + 1.0
        # Doubled until it is passed, then halved to the rounding: a pace has no inverse in closed
        # form.
        while self(high) < distance:
            high += high - low
        # 60 halvings: more than the 53 bits of a float64.
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
        # The ground is seen from above at an angle: ways into the depth are foreshortened.
        y = start.y - gone * north * math.sin(VIEW_ELEVATION)
        return replace(start, x=start.x + gone * east, y=y)

    return course


def swaying(
    course: Callable[[float], Placed], surge: Wave, weave: Wave
) -> Callable[[float], Placed]:
    """Follow a path or a course as a human drives: `surge` along x, `weave` along y."""

    def swayed(frame: float) -> Placed:
        # Position only: size and heading stay those of the course, as a driver's hand is small.
        placed = course(frame)
        return replace(placed, x=placed.x + surge(frame), y=placed.y + weave(frame))

    return swayed
