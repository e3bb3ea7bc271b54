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

"""A target that stays where it was given while other things move."""

from __future__ import annotations

import math

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size

PATIENCE = 5.0
"""Seconds without a movement before a target is doubted: a vehicle in traffic that other vehicles
pass rarely stands longer, but for a red light; then the warning is true, and ends as it drives."""
_WORDS = (
    f"the target has not moved for {PATIENCE:g} s while other things did: it stands, or it is no "
    "vehicle"
)
_DRIVEN = 0.5
"""Way from the first position, in widths of the box, that only a vehicle drives: that of a box on
an empty road trembled by less than a tenth of it."""
_EVERY = 0.5
"""Seconds between two looks at what else moves: a second at a junction shows several vehicles."""
_SIDE = 64
"""Longer side of the picture that is compared, px: a vehicle of 1/60 of the image is a pixel."""
_CHANGED = 12.0
"""Change of grey, of 255, that is a movement: above the noise of a camera at night, which the
reduction to 64 px divides by ten and more."""


class Stillness:
    """Watches whether a target moves, and what else does.

    Attributes
    ----------
    moved : float
        Largest distance from the first position, px.
    is_suspect : bool
        True while the target has not moved for `PATIENCE` seconds since its start, and other things
        have.
    """

    def __init__(self) -> None:
        self.begin(Box(0.0, 0.0, 1.0, 1.0), 0)

    def begin(self, box: Box, stamp_ns: int) -> None:
        """Watch a new target from its first box, px."""
        self.moved, self.is_suspect = 0.0, False
        self._first, self._began_ns = box, stamp_ns
        self._looked_ns: int | None = None
        self._before: Array | None = None
        self._others_move = False

    def look(self, frame: Frame, box: Box, stamp_ns: int) -> list[str]:
        """Take the target's box in the next image; return a warning where it becomes suspect."""
        self.moved = max(self.moved, math.dist(self._first.centre, box.centre))
        if self.moved > _DRIVEN * self._first.width:  # also of a car that parks later
            self.is_suspect = False
            return []
        if self._looked_ns is None or stamp_ns - self._looked_ns >= _EVERY * 1e9:
            self._looked_ns = stamp_ns
            self._compare(frame, box)
        waited = (stamp_ns - self._began_ns) * 1e-9
        was_suspect, self.is_suspect = self.is_suspect, self._others_move and waited >= PATIENCE
        return [_WORDS] if self.is_suspect and not was_suspect else []

    def _compare(self, frame: Frame, box: Box) -> None:
        """Note where the image, without the target, differs from that of the look before."""
        width, height = frame_size(frame)
        scale = min(_SIDE / max(width, height), 1.0)
        size = max(round(width * scale), 1), max(round(height * scale), 1)
        small = cv2.resize(frame, size, interpolation=cv2.INTER_AREA).mean(axis=2)
        left, top = (max(int(at * scale) - 1, 0) for at in (box.x, box.y))
        right, bottom = (
            math.ceil(at * scale) + 1 for at in (box.x + box.width, box.y + box.height)
        )
        if self._before is not None and self._before.shape == small.shape:
            change = np.abs(small - self._before)
            change[top:bottom, left:right] = 0.0
            self._others_move = self._others_move or bool(change.max() > _CHANGED)
        self._before = small
