# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of boxes: histograms from an image that is quantised once for all vehicles."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame

_LEVELS = 4
"""Levels of each channel: enough to tell colours, few enough for a box of 100 px to fill its 64
joint bins."""
COLOUR_BINS = _LEVELS**3
"""Joint bins of the three channels."""
BACKGROUND_RIM = 0.1
"""Margin on each side, of the size, that is left out as background: two standard deviations of an
edge at the usual `detections.edge_noise` of .05."""


class ColourBins:
    """Joint colour bins of a frame, which are counted where they are asked for."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame

    def histograms(self, edges: Array, covers: Sequence[Array]) -> Array:
        """Count the colours of the inner parts of boxes.

        Parameters
        ----------
        edges : (N, 4) array
            Edges of the boxes, px.
        covers : sequence of N (K, 4) arrays
            Edges of boxes whose pixels are left out of each.

        Returns
        -------
        (N, COLOUR_BINS) array
            Shares of the colours; zero where nothing of a box is in sight.
        """
        # Slices below clip at the far borders by themselves; a negative start would count from
        # there.
        margins = BACKGROUND_RIM * (edges[:, 2:] - edges[:, :2])
        low = np.maximum((edges[:, :2] + margins).astype(np.intp), 0)
        high = np.maximum((edges[:, 2:] - margins).astype(np.intp) + 1, 0)
        counts = np.zeros((len(edges), COLOUR_BINS), np.float32)
        boxes = zip(np.hstack([low, high]).tolist(), covers, strict=True)
        for row, ((left, top, right, bottom), cover) in enumerate(boxes):
            part = self._frame[top:bottom, left:right]
            if part.size:
                seen = _uncovered(part, cover - (left, top, left, top)) if len(cover) else None
                shares = cv2.calcHist([part], [0, 1, 2], seen, [_LEVELS] * 3, [0.0, 256.0] * 3)
                counts[row] = shares.ravel()
        # At least one, so that what is out of sight stays zero, the mark of the unknown.
        totals = np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
        return np.asarray(counts / totals, np.float64)


def _uncovered(part: Frame, covers: Array) -> npt.NDArray[np.uint8]:
    """Mask of the pixels of a part of the image that no nearer box covers, by its own pixels."""
    seen = np.ones(part.shape[:2], np.uint8)
    for left, top, right, bottom in np.maximum(covers, 0.0).astype(int).tolist():
        seen[top:bottom, left:right] = 0
    return seen


def similarities(some: Array, others: Array) -> Array:
    """Bhattacharyya coefficients (...) of histograms (..., COLOUR_BINS), 0 to 1."""
    return np.asarray(np.sqrt(some * others).sum(axis=-1))
