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

"""Doubts about a target that pixels raise: its own before it is followed, then those around it."""

from __future__ import annotations

import math

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size

SMALLEST_SIDE = 6.0
"""Side in px below which a box has too few pixels to be told apart: on truck4_1, of 5 px, no
tracker of docs/sequences.md is on target in more than an eighth of the frames."""
LARGEST_SHARE = 0.4
"""Share of the image above which a box leaves too little around it to be told apart from."""
LEAST_CONTRAST = 6.0
"""Contrast, of 255, below which a patch is an empty road. True boxes have at least 9.4 on truck4_1,
of 5 px, and 12.6 on the 18 other sequences; of boxes thrown into the lower part of their images,
which is mostly road, up to 47 % have less (`laboratory/target_contrast.py`)."""
_MARGIN = 0.25
"""Surroundings that belong to the patch, as a share of the box: a plain vehicle has its outline."""


def doubts(frame: Frame, box: Box) -> list[str]:
    """Return what speaks against following `box`, a clause each.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB image.
    box : Box
        Target in px, at least partly inside.
    """
    width, height = frame_size(frame)
    found = []
    if min(box.width, box.height) < SMALLEST_SIDE:
        found.append(f"it is only {box.width:g} x {box.height:g} px large")
    if box.area > LARGEST_SHARE * width * height:
        found.append(f"it covers {box.area / (width * height):.0%} of the image")
    if contrast(frame, box) < LEAST_CONTRAST:
        found.append("nothing in it stands out, as on an empty road")
    return found


def contrast(frame: Frame, box: Box) -> float:
    """Return the largest standard deviation of a colour in the box with a margin.

    Infinite where the box has no pixel in the image.
    """
    across, down = _MARGIN * box.width, _MARGIN * box.height
    left, top = max(int(box.x - across), 0), max(int(box.y - down), 0)
    right, bottom = np.ceil([box.x + box.width + across, box.y + box.height + down]).astype(int)
    patch = np.ascontiguousarray(frame[top : max(bottom, top), left : max(right, left)])
    # Smoothed, since noise is no structure.
    smooth = cv2.GaussianBlur(patch, (0, 0), 1.5) if patch.size else None
    return math.inf if smooth is None else float(smooth.std(axis=(0, 1)).max())


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
        right, bottom = (math.ceil(at * scale) + 1 for at in box.corners[2])
        if self._before is not None and self._before.shape == small.shape:
            change = np.abs(small - self._before)
            change[top:bottom, left:right] = 0.0
            self._others_move = self._others_move or bool(change.max() > _CHANGED)
        self._before = small
