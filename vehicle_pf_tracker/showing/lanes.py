# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lanes: how many vehicles passed each pixel, and in which direction."""

from __future__ import annotations

import math

import cv2
import numpy as np

from vehicle_pf_tracker.core.frame import Frame

_MOST_OPAQUE = 0.85
"""Opacity of the busiest lane, so that the road can be seen below it."""


class Lanes:
    """Sums of all vehicles' paths: how many passed a pixel, and in which direction.

    Parameters
    ----------
    size : (int, int)
        Height and width of the picture in px.
    """

    def __init__(self, size: tuple[int, int]) -> None:
        # Sums of the headings' cosines and sines, and the number of steps.
        self._sums = np.zeros((*size, 3), np.float32)

    def add(self, begin: tuple[int, int], end: tuple[int, int], width: int) -> None:
        """Add a step of a vehicle between two pixels."""
        if begin == end:
            return
        low = np.maximum(np.minimum(begin, end) - width, 0)
        high = np.maximum(begin, end) + width + 1
        part = self._sums[low[1] : high[1], low[0] : high[0]]
        if not part.size:
            return
        heading = np.subtract(end, begin) / math.dist(begin, end)
        mask = np.zeros(part.shape[:2], np.uint8)
        shift = low.tolist()
        points = [(x - shift[0], y - shift[1]) for x, y in (begin, end)]
        cv2.line(mask, points[0], points[1], 1, width)
        part[mask > 0] += np.array([*heading, 1.0], np.float32)

    def draw(self, picture: Frame) -> None:
        """Colour the picture by heading, stronger where more vehicles passed."""
        count = self._sums[:, :, 2]
        angle = np.arctan2(self._sums[:, :, 1], self._sums[:, :, 0])
        hue = ((angle / (2 * np.pi) % 1.0) * 180).astype(np.uint8)
        full = np.full_like(hue, 255)
        colours = cv2.cvtColor(np.dstack([hue, full, full]), cv2.COLOR_HSV2RGB).astype(np.float32)
        share = np.log1p(count) / max(float(np.log1p(count.max())), 1.0)
        opacity = (_MOST_OPAQUE * share)[:, :, None]
        picture[:] = (picture + opacity * (colours - picture)).astype(np.uint8)
