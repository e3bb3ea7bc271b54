# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of boxes: histograms from an image that is quantised once for all vehicles."""

from __future__ import annotations

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame

_LEVELS = 4
"""Levels of each channel: enough to tell colours, few enough for a box of 100 px."""
BINS = _LEVELS**3
"""Joint bins of the three channels."""
RIM = 0.1
"""Margin on each side, of the size, that is left out: background."""


class ColourBins:
    """Joint colour bins of a frame, which are counted where they are asked for."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame

    def histogram(self, edges: Array, covers: Array) -> Array:
        """Count the colours of a box's inner part.

        Parameters
        ----------
        edges : (4,) array
            Edges of the box, px.
        covers : (K, 4) array
            Edges of boxes whose pixels are left out.

        Returns
        -------
        (BINS,) array
            Shares of the colours; zero where nothing of the box is in sight.
        """
        left, top, right, bottom = edges.tolist()
        dx, dy = RIM * (right - left), RIM * (bottom - top)
        x0, x1 = max(int(left + dx), 0), max(int(right - dx) + 1, 0)
        y0, y1 = max(int(top + dy), 0), max(int(bottom - dy) + 1, 0)
        part, seen = self._frame[y0:y1, x0:x1], None
        if not part.size:
            return np.zeros(BINS)
        if len(covers):
            seen = np.ones(part.shape[:2], np.uint8)
            for cover in np.maximum(covers - (x0, y0, x0, y0), 0.0).astype(int).tolist():
                seen[cover[1] : cover[3], cover[0] : cover[2]] = 0
        counts = cv2.calcHist([part], [0, 1, 2], seen, [_LEVELS] * 3, [0.0, 256.0] * 3).ravel()
        return np.asarray(counts / max(float(counts.sum()), 1.0), np.float64)


def similarity(one: Array, other: Array) -> float:
    """Bhattacharyya coefficient of two histograms, 0 to 1."""
    return float(np.sqrt(one * other).sum())
