"""Where a thing of a scene is: functions from frame number to its box."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_pf_tracker.core.box import Box

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
