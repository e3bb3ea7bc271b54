# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Paths (boxes of things in the image) and courses (poses of vehicles on the ground), by frame."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.solids import ELEVATION

Path: TypeAlias = Callable[[float], Box]
"""Gives the box (px) a sprite fills at a frame number, counted from 0."""


@dataclass(frozen=True, slots=True)
class Still:
    """Stands for ever in `box`."""

    box: Box

    def __call__(self, frame: float) -> Box:
        """Give the same box for every `frame`."""
        return self.box


@dataclass(frozen=True, slots=True)
class Straight:
    """Moves from `start` (its box in frame 0) with `velocity` (px/frame, in x and y)."""

    start: Box
    velocity: tuple[float, float]

    def __call__(self, frame: float) -> Box:
        """Give the box in `frame`."""
        dx, dy = self.velocity
        start = self.start
        return Box(start.x + dx * frame, start.y + dy * frame, start.width, start.height)


@dataclass(frozen=True, slots=True)
class Wave:
    """A slow swing: `amplitude` (px), `period` (frames) and `phase` (rad)."""

    amplitude: float
    period: float
    phase: float

    def __call__(self, frame: float) -> float:
        """Give the displacement in `frame`, px."""
        return self.amplitude * math.sin(2 * math.pi * frame / self.period + self.phase)


@dataclass(frozen=True, slots=True)
class Driven:
    """Follows `course` as a human drives: `surge` along x, `weave` along y."""

    course: Path
    surge: Wave
    weave: Wave

    def __call__(self, frame: float) -> Box:
        """Give the box in `frame`."""
        box = self.course(frame)
        return Box(box.x + self.surge(frame), box.y + self.weave(frame), box.width, box.height)


@dataclass(frozen=True, slots=True)
class Attached:
    """Stays with `leader`: `offset` (px) from its corner, of its own `size` (px)."""

    leader: Path
    offset: tuple[float, float]
    size: tuple[float, float]

    def __call__(self, frame: float) -> Box:
        """Give the box in `frame`."""
        box = self.leader(frame)
        return Box(box.x + self.offset[0], box.y + self.offset[1], *self.size)


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


@dataclass(frozen=True, slots=True)
class Bend:
    """Drives straight, then along an arc, and straight on; as flat ground looks from `ELEVATION`.

    Attributes
    ----------
    start : Pose
        The pose from which `pace` counts.
    pace : Pace
        Distance on the ground, px.
    straight, radius : float
        Length before the arc and radius of the arc, px.
    angle : float
        Change of heading, at most pi/2, to the left if positive, rad; 0 goes straight for ever.
    """

    start: Pose
    pace: Pace
    straight: float = 0.0
    radius: float = 1.0
    angle: float = 0.0

    def __call__(self, frame: float) -> Pose:
        """Give the pose in `frame`."""
        gone = self.pace(frame)
        before = gone if self.angle == 0 else min(gone, self.straight)
        arc = min(gone - before, self.radius * abs(self.angle))
        after = gone - before - arc
        side = math.copysign(1.0, self.angle)
        turn = side * arc / self.radius
        along = before + self.radius * abs(math.sin(turn)) + after * math.cos(turn)
        across = side * self.radius * (1 - math.cos(turn)) + after * math.sin(turn)
        east, north = _rotated(along, across, self.start.heading)
        return Pose(
            self.start.x + east,
            self.start.y - north * math.sin(ELEVATION),
            self.start.heading + turn,
            self.start.scale,
        )


@dataclass(frozen=True, slots=True)
class Swaying:
    """Follows `course` as a human drives: `surge` along x, `weave` along y."""

    course: Course
    surge: Wave
    weave: Wave

    def __call__(self, frame: float) -> Pose:
        """Give the pose in `frame`."""
        pose = self.course(frame)
        x, y = pose.x + self.surge(frame), pose.y + self.weave(frame)
        return Pose(x, y, pose.heading, pose.scale)


def _rotated(along: float, across: float, heading: float) -> tuple[float, float]:
    cosine, sine = math.cos(heading), math.sin(heading)
    return along * cosine - across * sine, along * sine + across * cosine
