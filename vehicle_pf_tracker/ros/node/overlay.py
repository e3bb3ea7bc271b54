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

"""The image with what the tracker makes of it: box, path, particles, mode."""

from __future__ import annotations

from collections import deque

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.lettering import line_width, write_words
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

PATH_LENGTH = 300
"""Positions shown of the path."""

_COLOURS = {
    Mode.TRACKING.value: (64, 220, 64),
    Mode.OCCLUDED.value: (255, 176, 0),
    Mode.LOST.value: (255, 48, 48),
}
_NEUTRAL = (200, 200, 200)
_PARTICLE = (96, 160, 255)


class Overlay:
    """Remembers the path and draws; the frame itself is not written to."""

    def __init__(self) -> None:
        self._path: deque[tuple[float, float]] = deque(maxlen=PATH_LENGTH)

    def discard_path(self) -> None:
        """Begin a new path."""
        self._path.clear()

    def follow(self, estimate: Estimate) -> None:
        """Add a position to the path."""
        self._path.append(estimate.position)

    def draw(self, frame: Frame, mode: str, estimate: Estimate | None, more: str = "") -> Frame:
        """Return a drawn-on copy of `frame`, contiguous; `more` is written after the mode."""
        picture = np.array(frame, order="C")
        thickness = line_width(frame)
        colour = _COLOURS.get(mode, _NEUTRAL)
        if estimate is not None:
            for centre in _pixels(estimate.particles):
                cv2.circle(picture, centre, thickness, _PARTICLE, -1)
            path = np.array(_pixels(np.asarray(self._path).reshape(-1, 2)), np.int32)
            cv2.polylines(picture, [path.reshape(-1, 1, 2)], False, colour, thickness, cv2.LINE_AA)
            corners = _pixels(np.asarray(estimate.box.corners))
            cv2.rectangle(picture, corners[0], corners[2], colour, thickness)
        words = mode if estimate is None else f"{mode} {estimate.confidence:.2f}"
        words = f"{words}  {more}" if more else words
        write_words(picture, words, (5 * thickness, 14 * thickness), colour, thickness)
        return picture


def _pixels(points: Array) -> list[tuple[int, int]]:
    """Give the pixel that each continuous position (N, 2) lies in."""
    return [(int(x), int(y)) for x, y in np.floor(points)]
