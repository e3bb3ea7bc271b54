# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The predicted path of a hidden vehicle before a standing camera.

The vehicle is neither behind the position where it was last seen, nor far ahead of the prediction,
where the vehicle ahead in its lane drives. Where nothing moves at the predicted position, something
that stands covers it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.behind import is_behind
from vehicle_pf_tracker.trackers.fusion.outline_boxes import LEAST_AREA, areas
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting

_EARLY = 1.0
"""Distance in predicted sizes ahead of the prediction beyond which no hypothesis is the vehicle:
there is the one ahead of it in its lane. Chosen after seven of 14 wrong returns, and four of 129
right ones, had been seen beyond it; behind the prediction there is no such bound, as vehicles brake
(laboratory/notes/fusion_tried.md)."""
_EVERY = 2
"""Frames from one examination of the outlines to the next: half of the cost. A choice."""

Mask = npt.NDArray[np.bool_]


class HiddenWay(NamedTuple):
    """Predicted path of a hidden vehicle, and whether something covers it there.

    Attributes
    ----------
    last : Sighting
        Last clear sighting of the vehicle.
    motion : PerspectiveMotion
        Motion of the vehicle then, whose time 0 is that sighting.
    age : float
        Periods since that sighting.
    rested : int
        Frames since the outlines were last examined.
    is_covered : bool
        True where nothing moved in the middle of the predicted box then: what covers the vehicle is
        a part of the background.
    """

    last: Sighting
    motion: PerspectiveMotion
    age: float
    rested: int = _EVERY
    is_covered: bool = False

    @property
    def place(self) -> tuple[Array, Array]:
        """Centre and size, px, of the predicted box."""
        return self.motion.position_at(self.age), self.last.size * self.motion.scale_at(self.age)

    def aged(self, elapsed: float) -> HiddenWay:
        """Let a frame pass, `elapsed` periods after the last one."""
        return self._replace(age=self.age + elapsed, rested=self.rested + 1)

    @property
    def is_due(self) -> bool:
        """True in every second frame."""
        return self.rested >= _EVERY

    def looked(self, boxes: Array) -> HiddenWay:
        """Test whether one of these bounding boxes (N, 2, 2), px, is at the predicted position."""
        position, size = self.place
        # The middle half of the predicted box: only the vehicle's own rest may be seen there.
        is_there = (boxes[:, 0] < position + size / 4) & (boxes[:, 1] > position - size / 4)
        is_large = areas(boxes) > LEAST_AREA * size.prod()
        return self._replace(rested=0, is_covered=not (is_there.all(axis=1) & is_large).any())

    def excludes(self, positions: Array) -> Mask:
        """Test at which positions (..., 2), px, no hypothesis is the vehicle."""
        behind = is_behind(positions, self.motion, self.last, self.age)
        return np.asarray((self._ahead(positions) > _EARLY) | behind)

    def _ahead(self, positions: Array) -> Array:
        """Distances (...) of positions ahead of the prediction, along its heading, in its sizes."""
        position, size = self.place
        velocity = self.motion.velocity_at(self.age)
        # 1e-9: of a vehicle that stood nothing is ahead or behind.
        heading = velocity / max(float(np.hypot(*velocity)), 1e-9)
        return np.asarray((positions - position) @ heading / np.sqrt(size.prod()))
