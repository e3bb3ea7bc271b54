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

"""A vehicle that comes out beside its path, before a camera that stands.

One that turns while it is hidden shows a side that its filter does not know, where nobody looks for
it. If nothing else has moved around for two seconds before, and one single thing appears away from
the border then, of the vehicle's size and speed, where it can be, that is the vehicle.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.perspective import KEPT_FRAMES, PerspectiveMotion, Sighting

_FRAMES, _MOVED = 8, 0.5
"""Frames in a row that prove it, and its way in them, of the size: as for a return."""
_SPEEDS = 0.4, 1.6
"""Speed of what comes out, of the vehicle's before: vehicles brake and accelerate while hidden."""
_LEAST_AREA, _LARGEST_AREA = 0.2, 2.0
"""Area of its bounding box, of the vehicle's: end on a car has half of what it has from aside."""
_LEAST_MOVING = 0.03
"""The same from which something is seen to move: less flickers."""


class Emergence:
    """Watches what moves around a hidden vehicle.

    Parameters
    ----------
    last : Sighting
        Where the vehicle was last seen clearly.
    motion : PerspectiveMotion
        Its motion then.
    image_size : (2,) array
        Width and height of the frame, px.
    earlier : iterable of (float, (N, 2, 2) array)
        Frames since, and bounding boxes (low, high; px) of what moved then.

    Attributes
    ----------
    is_alone : bool
        True as long as nothing else has moved around; nothing is found any more once it is False.
    motion : PerspectiveMotion
        As given.
    """

    def __init__(
        self, last: Sighting, motion: PerspectiveMotion, image_size: Array,
        earlier: Iterable[tuple[float, Array]],
    ) -> None:  # fmt: skip
        self._centre, self._size, self._image_size = last.position, last.size, image_size
        self._extent = float(np.sqrt(last.size.prod()))
        self._speed = float(np.hypot(*motion.velocity))
        self.motion, self._age = motion, 0.0
        self._sides: list[Array] = []
        self._unlike: list[float] = []
        self.is_alone = all(
            not len(self._near(boxes, last.position - motion.velocity * ago))
            for ago, boxes in earlier
        )

    def _near(self, boxes: Array, own: Array | None) -> Array:
        """Choose the boxes within reach that are not at the vehicle's `own` position."""
        middles, areas = boxes.mean(axis=1), (boxes[:, 1] - boxes[:, 0]).prod(axis=1)
        reach = KEPT_FRAMES * self._speed + 2 * self._extent
        counts = np.linalg.norm(middles - self._centre, axis=1) < reach
        counts &= areas > _LEAST_MOVING * self._extent**2
        if own is not None:
            counts &= (np.abs(middles - own) > self._size).any(axis=1)
        return np.asarray(boxes[counts])

    def step(self, boxes: Array, elapsed: float) -> tuple[Array, Array] | None:
        """Take what moves now; sides (2, 2) and velocity of the vehicle once it is proven."""
        self._age += elapsed
        # At first the rest of the vehicle goes in.
        boxes = self._near(
            boxes, self._centre if self._speed * self._age < 2 * self._extent else None
        )
        areas = (boxes[:, 1] - boxes[:, 0]).prod(axis=1) / self._extent**2
        self.is_alone &= len(boxes) < 2 and bool((areas < _LARGEST_AREA).all())
        if not self.is_alone or not len(boxes):
            self._sides = []
            return None
        sides = boxes[0]
        if not self._sides:
            self.is_alone = self._can_begin(sides)
        elif np.abs(sides - self._sides[-1]).max() > self._extent:
            self._sides = []
        self._sides.append(sides)
        return self._proven(elapsed) if areas[0] > _LEAST_AREA else None

    def has_paint(self, unlike: float) -> bool:
        """Take how far its paint is from the vehicle's, from 1 another's; judge all frames so far.

        In a single one the windows of a stranger may look like the vehicle.
        """
        self._unlike.append(unlike)
        return bool(np.mean(self._unlike) < 1)

    def _can_begin(self, sides: Array) -> bool:
        """Test whether the vehicle can be there already, and nothing enters by the border."""
        enters = (sides <= 0).any() or (sides >= self._image_size).any()
        far = np.hypot(*(sides.mean(axis=0) - self._centre))
        reached = far < _SPEEDS[1] * self._speed * self._age + self._extent
        return bool(reached and not enters)

    def _proven(self, elapsed: float) -> tuple[Array, Array] | None:
        sides, frames = self._sides[-1], len(self._sides)
        # The side in front moves all the time, the other one once all has come out.
        moves = sides - self._sides[0]
        moved = np.where(np.abs(moves[1]) > np.abs(moves[0]), moves[1], moves[0])
        if frames < _FRAMES or np.hypot(*moved) < _MOVED * self._extent:
            return None
        velocity = moved / max((frames - 1) * elapsed, 1e-3)
        slowest, fastest = np.array(_SPEEDS) * self._speed
        return (sides, velocity) if slowest < np.hypot(*velocity) < fastest else None
