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

"""Target as it was in the first frame."""

from __future__ import annotations

import math

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.colour import Histogram, joint_histogram
from vehicle_pf_tracker.image.window import Window
from vehicle_pf_tracker.trackers.contract import WindowParameters

_MARGIN = 64
"""Least margin kept around the target, in px, so that a wider window can still be measured: of
small targets, windows of several times their size."""


class Target:
    """Patch of the first frame around the target.

    References can be rebuilt from it when window, bins or features change while tracking, without
    learning whatever hides the target by then.

    Parameters
    ----------
    frame : (H, W, 3) array
        First frame; the part that is kept is copied.
    box : Box
        Box of the target in it.
    """

    def __init__(self, frame: Frame, box: Box) -> None:
        width, height = frame_size(frame)
        margin = max(_MARGIN, math.ceil(max(box.width, box.height)))
        left = max(math.floor(box.x) - margin, 0)
        top = max(math.floor(box.y) - margin, 0)
        right = min(math.ceil(box.x + box.width) + margin, width)
        bottom = min(math.ceil(box.y + box.height) + margin, height)
        self.box = box
        self.patch: Frame = frame[top:bottom, left:right].copy()
        self.centre = box.centre[0] - left, box.centre[1] - top

    def window(self, size: WindowParameters) -> Window:
        """Return the window of the given size; where that is 0, of the target's own."""
        return Window.of_size(size.width or self.box.width, size.height or self.box.height)

    def joint_histogram(self, window: Window, bits: int) -> Histogram:
        """Return the joint RGB histogram of the target in the first frame."""
        return joint_histogram(self.patch, self.centre, window, bits)
