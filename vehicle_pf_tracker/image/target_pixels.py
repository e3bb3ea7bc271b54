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

"""Doubts about a target that its pixels raise, before it is followed."""

from __future__ import annotations

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size

SMALLEST_SIDE = 6.0
"""Side in px below which a box has too few pixels to be told apart: on `uav123`'s truck of 5 px all
trackers of docs/sequences.md are lost."""
LARGEST_SHARE = 0.4
"""Share of the image above which a box leaves too little around it to be told apart from."""
LEAST_CONTRAST = 4.0
"""Standard deviation of a colour, of 255, below which a patch is an empty road: noise and texture
of asphalt reach 2 to 3, the plainest van with its windows and wheels 15."""
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
    patch = _patch(frame, box)
    # Smoothed, since noise is no structure.
    if patch.size and cv2.GaussianBlur(patch, (0, 0), 1.5).std(axis=(0, 1)).max() < LEAST_CONTRAST:
        found.append("nothing in it stands out, as on an empty road")
    return found


def _patch(frame: Frame, box: Box) -> Frame:
    """Return the part of `frame` that shows `box` with a margin."""
    across, down = _MARGIN * box.width, _MARGIN * box.height
    left, top = max(int(box.x - across), 0), max(int(box.y - down), 0)
    right, bottom = np.ceil([box.x + box.width + across, box.y + box.height + down]).astype(int)
    patch: Frame = np.ascontiguousarray(frame[top : max(bottom, top), left : max(right, left)])
    return patch
