# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Doubt about a target that does not move while other things do: a verge, asphalt, a sign."""

from __future__ import annotations

import math

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size

STILLNESS_PATIENCE = 5.0
"""Seconds without a movement before a target is doubted: a vehicle in traffic that other vehicles
pass rarely stands longer, but for a red light; then the warning is true, and ends as it drives."""
STILLNESS_SENTENCE = (
    f"the target has not moved for {STILLNESS_PATIENCE:g} s while other things did: it stands, "
    "or it is not a vehicle"
)
_DRIVEN = 0.5
"""Way from the first position, in widths of the box, that only a vehicle drives: that of a box on
an empty road trembled by less than a tenth of it."""
_GROWN = 1.25
"""Ratio of widths that only a vehicle shows which comes straight on or drives away: an estimated
width trembles by less than a tenth."""
_EVERY = 0.5
"""Seconds between two looks at what else moves: a second at a junction shows several vehicles."""
_SIDE = 64
"""Longer side of the picture that is compared, px: a vehicle of 1/60 of the image is a pixel."""
_CHANGED = 12.0
"""Change of grey, of 255, that is a movement: above the noise of a camera at night, which the
reduction to 64 px divides by ten and more."""
_CAMERA_SHARE = 0.2
"""Share of the picture that changes when the camera moves, or the light does: traffic before a
standing camera changes less, and with the camera a followed vehicle may well stay where it is."""


class Stillness:
    """Watches whether a target moves, and what else does.

    Attributes
    ----------
    is_suspect : bool
        True while the target has not moved for `STILLNESS_PATIENCE` seconds since its start,
        and other things have.
    """

    def __init__(self) -> None:
        self.begin(Box(0.0, 0.0, 1.0, 1.0), 0)

    def begin(self, box: Box, stamp_ns: int) -> None:
        """Watch a new target from its first box, px."""
        self.is_suspect = False
        self._first = box
        self._began_ns = stamp_ns
        # Since this target began; whatever moved before was another one.
        self._has_driven = False
        self._looked_ns: int | None = None
        self._before: Array | None = None
        self._others_move = False

    def look(self, frame: Frame, box: Box, stamp_ns: int) -> list[str]:
        """Take the visible target's box in the next image; return a warning where it is suspect.

        It is returned once; `is_suspect` lasts.
        """
        # Once driven, always driven: a car that parks later is a vehicle.
        self._has_driven = self._has_driven or self._is_elsewhere(box)
        if self._has_driven:
            self.is_suspect = False
            return []
        if self._looked_ns is None or stamp_ns - self._looked_ns >= _EVERY * 1e9:
            self._looked_ns = stamp_ns
            # Kept once seen: traffic that has passed proves that the camera sees motion.
            self._others_move = self._compare(frame, box) or self._others_move
        waited = (stamp_ns - self._began_ns) * 1e-9
        was_suspect = self.is_suspect
        self.is_suspect = self._others_move and waited >= STILLNESS_PATIENCE
        return [STILLNESS_SENTENCE] if self.is_suspect and not was_suspect else []

    def _is_elsewhere(self, box: Box) -> bool:
        distance = math.dist(self._first.centre, box.centre)
        growth = box.width / self._first.width
        return distance > _DRIVEN * self._first.width or not 1 / _GROWN < growth < _GROWN

    def _compare(self, frame: Frame, box: Box) -> bool:
        """Return whether the image, without the target, shows a movement since the last look."""
        width, height = frame_size(frame)
        scale = min(_SIDE / max(width, height), 1.0)
        size = max(round(width * scale), 1), max(round(height * scale), 1)
        # Averaged to 64 px: noise of single pixels is gone, vehicles are still seen.
        small = cv2.resize(frame, size, interpolation=cv2.INTER_AREA).mean(axis=2)
        before = self._before
        self._before = small
        # Images of another size have no difference.
        if before is None or before.shape != small.shape:
            return False
        is_changed = np.abs(small - before) > _CHANGED
        left, top = box.corners[0]
        right, bottom = box.corners[2]
        # A pixel more on each side: the target trembles in its own box.
        low = [max(int(at * scale) - 1, 0) for at in (left, top)]
        high = [max(math.ceil(at * scale) + 1, 0) for at in (right, bottom)]
        is_changed[low[1] : high[1], low[0] : high[0]] = False
        # All that changes at once is the camera or a cloud, and proves nothing of the target.
        return 0.0 < float(is_changed.mean()) <= _CAMERA_SHARE
