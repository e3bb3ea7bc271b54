"""Where a thing of a scene is: functions from frame number to its box."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_pf_tracker.features.box import Box

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
