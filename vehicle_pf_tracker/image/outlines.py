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

"""Outlines drawn into images."""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame

Colour = tuple[int, int, int]
"""Red, green, blue."""

_DASH = 6
"""Length of a dash and of a gap, in line widths."""
_FAR = 20_000
"""Pixels beyond which OpenCV's coordinates, of 16 bits and a fraction, overflow."""


def pixels_at(points: Array) -> list[tuple[int, int]]:
    """Return the pixel that each continuous position (N, 2) lies in."""
    return [(int(x), int(y)) for x, y in np.floor(np.clip(points, -_FAR, _FAR))]


def draw_box(picture: Frame, box: Box, colour: Colour, width: int, *, dashed: bool = False) -> None:
    """Draw a box of px into `picture`, its lines `width` px wide."""
    corners = pixels_at(np.asarray(box.corners))
    if not dashed:
        cv2.rectangle(picture, corners[0], corners[2], colour, width)
        return
    for start, end in pairwise((*corners, corners[0])):
        _draw_dashes(picture, np.array(start, float), np.array(end, float), colour, width)


def _draw_dashes(picture: Frame, start: Array, end: Array, colour: Colour, width: int) -> None:
    length = float(np.hypot(*(end - start)))
    for along in np.arange(0.0, length, 2 * _DASH * width):
        ends = start + (end - start) / length * np.array([[along], [along + _DASH * width]])
        a, b = pixels_at(ends)
        cv2.line(picture, a, b, colour, width)
