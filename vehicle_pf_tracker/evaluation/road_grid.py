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

"""Pictures to read points of the road off an image, and to check a calibration with."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.lettering import write_words
from vehicle_pf_tracker.road.plane import Pair, RoadPlane

_LINE, _TEXT = (255, 240, 80), (255, 255, 255)
_POINT, _ROAD = (255, 60, 60), (80, 220, 255)
_STEPS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Distances of lines, px or m."""
_LINES = 12
"""Lines across the image, about: enough to read a point to a fifth of their distance."""
_PIECES = 60
"""Pieces that a line of the road is drawn in, which the lens may bend."""


def draw_pixel_grid(frame: Frame) -> Frame:
    """Draw lines with their pixel coordinates over a copy of `frame`."""
    picture = np.array(frame, order="C")
    width, height = frame_size(frame)
    step = _step(max(width, height) / _LINES)
    for x in range(step, width, step):
        cv2.line(picture, (x, 0), (x, height - 1), _LINE, 1)
        write_words(picture, str(x), (x + 2, 11), _TEXT)
    for y in range(step, height, step):
        cv2.line(picture, (0, y), (width - 1, y), _LINE, 1)
        write_words(picture, str(y), (2, y - 3), _TEXT)
    return picture


def draw_road_grid(frame: Frame, plane: RoadPlane, pairs: Sequence[Pair]) -> Frame:
    """Draw lines of the road with their metres, and the pairs, over a copy of `frame`."""
    picture = np.array(frame, order="C")
    points = np.array([pair.road for pair in pairs])
    low, high = points.min(axis=0), points.max(axis=0)
    for axis in (0, 1):
        step = _step(float(high[axis] - low[axis]) / _LINES)
        first, last = np.ceil(low[axis] / step), np.floor(high[axis] / step)
        for number in np.arange(first, last + 1) * step:
            _draw_line(picture, plane, axis, float(number), (low, high))
    for pair in pairs:
        u, v = np.floor(pair.pixel).astype(int).tolist()
        cv2.drawMarker(picture, (u, v), _POINT, cv2.MARKER_CROSS, 11, 1)
        words = f"{pair.road[0]:g},{pair.road[1]:g}"
        write_words(picture, words, (u + 6, v - 4), _TEXT)
    return picture


def _draw_line(
    picture: Frame, plane: RoadPlane, axis: int, number: float, bounds: tuple[Array, Array]
) -> None:
    """Draw the line of the road where the coordinate `axis` is `number`."""
    low, high = bounds
    line = np.empty((_PIECES, 2))
    line[:, axis] = number
    line[:, 1 - axis] = np.linspace(low[1 - axis], high[1 - axis], _PIECES)
    pixels = np.clip(np.floor(plane.to_image(line)), -(2**14), 2**14).astype(np.int32)
    cv2.polylines(picture, [pixels.reshape(-1, 1, 2)], False, _ROAD, 1, cv2.LINE_AA)
    u, v = pixels[0].tolist()
    write_words(picture, f"{'xy'[axis]}={number:g}", (u + 2, v + 12), _TEXT)


def _step(least: float) -> int:
    return next((step for step in _STEPS if step >= least), _STEPS[-1])
