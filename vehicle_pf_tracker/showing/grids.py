# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Grids drawn over an image: its pixels, or the metres of the road."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.road.plane import Pair, RoadPlane
from vehicle_pf_tracker.showing.drawing import (
    Labels,
    line_width,
    pixels_at,
    write_labels,
    write_words,
)

_STEPS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Distances of lines, px or m: round numbers, between which people read fractions."""
_LINES = 12
"""Lines across the image, about: enough to read a point to a fifth of their distance."""
_PIECES = 60
"""Pieces that a line of the road is drawn in, which the lens may bend: over a right angle, two
pieces differ by 1.5 degrees."""
# Colours of the grids, which stand out on grey roads and green verges.
_LINE = (255, 240, 80)
_TEXT = (255, 255, 255)
_POINT = (255, 60, 60)
_ROAD = (80, 220, 255)


def draw_pixel_grid(frame: Frame) -> Frame:
    """Draw lines with their pixel coordinates over a copy of `frame`."""
    picture = np.array(frame, order="C")
    width, height = frame_size(frame)
    pen = max(1, line_width(picture) // 2)
    step = _step(max(width, height) / _LINES)
    for x in range(step, width, step):
        cv2.line(picture, (x, 0), (x, height - 1), _LINE, pen)
        write_words(picture, str(x), (x + 2 * pen, 11 * pen), _TEXT, pen)
    for y in range(step, height, step):
        cv2.line(picture, (0, y), (width - 1, y), _LINE, pen)
        write_words(picture, str(y), (2 * pen, y - 3 * pen), _TEXT, pen)
    return picture


def draw_road_grid(frame: Frame, plane: RoadPlane, pairs: Sequence[Pair]) -> Frame:
    """Draw lines of the road with their metres, and the pairs, over a copy of `frame`."""
    picture: Frame = np.array(frame, order="C")
    width = max(1, line_width(picture) // 2)
    labels: Labels = [
        (Box.around(pair.pixel, 0, 0), _TEXT, (f"{pair.road[0]:g},{pair.road[1]:g}",))
        for pair in pairs
    ]
    points = np.array([pair.road for pair in pairs])
    low = points.min(axis=0)
    high = points.max(axis=0)
    for axis in (0, 1):
        step = _step(float(high[axis] - low[axis]) / _LINES)
        first = np.ceil(low[axis] / step)
        last = np.floor(high[axis] / step)
        line = np.empty((_PIECES, 2))
        line[:, 1 - axis] = np.linspace(low[1 - axis], high[1 - axis], _PIECES)
        for number in np.arange(first, last + 1) * step:
            line[:, axis] = number
            pixels = np.clip(np.floor(plane.to_image(line)), -(2**14), 2**14).astype(np.int32)
            cv2.polylines(picture, [pixels.reshape(-1, 1, 2)], False, _ROAD, width, cv2.LINE_AA)
            at = Box.around(pixels[0].tolist(), 0, 0)
            labels.append((at, _TEXT, (f"{'xy'[axis]}={number:g}", "")))  # left out without room
    for centre in pixels_at(np.array([pair.pixel for pair in pairs])):
        cv2.drawMarker(picture, centre, _POINT, cv2.MARKER_CROSS, 11 * width, width)
    write_labels(picture, labels, width)
    return picture


def _step(least: float) -> int:
    """Return the least of the round distances, px or m, that is at least `least`; else the last."""
    return next((step for step in _STEPS if step >= least), _STEPS[-1])
