# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A hidden vehicle that appears beside its predicted path, before a standing camera.

One that turns while it is hidden appears where no hypothesis is, with a side that the filter does
not know. A single outline is taken for it if nothing else has moved nearby for two seconds, and if
it appears away from the border, within the vehicle's reach, with its size and speed.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.departure import PROOF_DISTANCE
from vehicle_pf_tracker.trackers.fusion.outline_boxes import (
    LEAST_AREA,
    MOST_AREA,
    areas,
    front_move,
)
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.perspective import KEPT_FRAMES, PerspectiveMotion, Sighting

_SPEEDS = 0.4, 1.6
"""Bounds of the speed of what comes out, fractions of the vehicle's before: it may brake to less
than half or accelerate by half while hidden; a stranger of any other speed is excluded."""
_LEAST_MOVING = 0.03
"""Least area of something that moves, fraction of the vehicle's: less flickers, by the noise of the
camera. Of a vehicle of 30 x 30 px that is 27 px squared. With `LEAST_AREA` what comes out is seen
too late (laboratory/notes/fusion_tried.md)."""


class Emergence(NamedTuple):
    """Moving outlines around a hidden vehicle, while there is at most one per frame.

    Attributes
    ----------
    last : Sighting
        Last clear sighting of the vehicle.
    motion : PerspectiveMotion
        Motion of the vehicle then, whose time 0 is that sighting.
    image_size : (2,) array
        Width and height of the frame, px.
    age : float
        Periods since the vehicle was hidden.
    sides : tuple of (2, 2) arrays
        Bounding boxes (low, high; px) of the one that moves, in the last frames.
    since : float
        Age at the first of these boxes.
    paint : tuple of float
        Differences of its paint from the vehicle's, in the frames in which it was proven.
    """

    last: Sighting
    motion: PerspectiveMotion
    image_size: Array
    age: float = 0.0
    sides: tuple[Array, ...] = ()
    since: float = 0.0
    paint: tuple[float, ...] = ()

    def was_alone(self, earlier: Iterable[tuple[float, Array]]) -> bool:
        """Test whether nothing else moved before; `earlier` has ages in frames, and boxes."""
        # A stranger that moved before may be hidden now, too, and come out in the vehicle's stead.
        last = self.last
        velocity = self.motion.velocity
        # Ages count from now, and the last sighting is older than that.
        return not any(
            len(self._near(boxes, last.position - velocity * (ago - last.age)))
            for ago, boxes in earlier
        )

    @property
    def _extent(self) -> float:
        return float(np.sqrt(self.last.size.prod()))

    @property
    def _speed(self) -> float:
        return float(np.hypot(*self.motion.velocity))

    def _area(self, sides: Array) -> float:
        """Area of a bounding box (2, 2), as a fraction of the vehicle's."""
        return float((sides[1] - sides[0]).prod() / self._extent**2)

    def _near(self, boxes: Array, own: Array | None) -> Array:
        """Choose the boxes within reach that are not at the vehicle's `own` position."""
        # As far as the vehicle would drive in the two seconds that sightings are kept for, and two
        # sizes more for boxes that are counted by their middles.
        middles = boxes.mean(axis=1)
        reach = KEPT_FRAMES * self._speed + 2 * self._extent
        counts = np.linalg.norm(middles - self.last.position, axis=1) < reach
        counts &= areas(boxes) > _LEAST_MOVING * self._extent**2
        if own is not None:
            # Its pieces lie within its own box: a middle a whole size away is another one's.
            counts &= (np.abs(middles - own) > self.last.size).any(axis=1)
        return np.asarray(boxes[counts])

    def observed(self, boxes: Array, elapsed: float) -> Emergence | None:
        """Take what moves now; None once anything else does."""
        # `None` ends the search for good: of several things that move none can be proven to be it.
        new = self._replace(age=self.age + elapsed)
        extent = self._extent
        # At first the rest of the vehicle goes in: for the time of two sizes, since it may brake to
        # less than half of its speed meanwhile (`_SPEEDS`).
        is_entering = self._speed * new.age < 2 * extent
        boxes = self._near(boxes, self.last.position if is_entering else None)
        if not len(boxes):
            return new._replace(sides=())
        if len(boxes) > 1 or self._area(boxes[0]) >= MOST_AREA:
            return None
        sides = boxes[0]
        before = self.sides
        if not before and not new._can_begin(sides):
            return None
        # A jump is another thing, or a merged outline: the proof begins again, the search goes on.
        if before and np.abs(sides - before[-1]).max() > extent:
            before = ()
        since = self.since if before else new.age
        return new._replace(sides=(*before, sides), since=since)

    def proven(self) -> tuple[Array, Array] | None:
        """Sides (2, 2), px, and velocity (2,), px per frame, if size, way and speed prove it."""
        frames = len(self.sides)
        if frames < PROOF_FRAMES or self._area(sides := self.sides[-1]) <= LEAST_AREA:
            return None
        moved = front_move(self.sides[0], sides)
        if np.hypot(*moved) < PROOF_DISTANCE * self._extent:
            return None
        # 1e-3 frames instead of none, where stamps repeat: such a speed is excluded below.
        velocity = moved / max(self.age - self.since, 1e-3)
        slowest, fastest = np.array(_SPEEDS) * self._speed
        return (sides, velocity) if slowest < np.hypot(*velocity) < fastest else None

    @property
    def has_paint(self) -> bool:
        """True if its paint is the vehicle's in the mean; windows of a stranger may look alike."""
        # 1 is the limit of `Appearance.paint_difference`.
        return bool(np.mean(self.paint) < 1)

    def _can_begin(self, sides: Array) -> bool:
        """Test whether the vehicle can be there already, and nothing enters by the border."""
        # What touches the border may have come from outside, and is a stranger then.
        enters = (sides <= 0).any() or (sides >= self.image_size).any()
        far = np.hypot(*(sides.mean(axis=0) - self.last.position))
        return not enters and bool(far < _SPEEDS[1] * self._speed * self.age + self._extent)
