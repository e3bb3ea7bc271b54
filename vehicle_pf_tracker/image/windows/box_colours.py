# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of boxes of any size, counted in joint bins of few levels."""

from __future__ import annotations

from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame

Rectangles: TypeAlias = npt.NDArray[np.int64]
Counts: TypeAlias = npt.NDArray[np.int32]

LEVELS = 4
"""Levels of each channel: enough to distinguish colours, few enough for a box of 100 px to fill its
64 joint bins."""
COLOUR_BINS = LEVELS**3
"""Joint bins of the three channels."""
_CHANNELS = [0, 1, 2]
_COUNTS = [LEVELS] * 3
_RANGES = [0.0, 256.0] * 3
"""Channels, levels and ranges in the words of OpenCV."""


def count_colours(frame: Frame, boxes: Rectangles, covers: Rectangles, ends: Rectangles) -> Counts:
    """Count the pixels of each colour in boxes, but not below what covers them.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    boxes : (N, 4) array
        Left, top, right and bottom, px; pixels from left to below right, as far as there are any.
    covers : (M, 4) array
        Boxes whose pixels are left out, in the same form, those over the first box first.
    ends : (N,) array
        Number of the covers of each box and of those before it.

    Returns
    -------
    (N, COLOUR_BINS) array
        Numbers of pixels; all kernels give the same.
    """
    counts = np.zeros((len(boxes), COLOUR_BINS), np.int32)
    above = covers.tolist()
    first = 0
    for row, (box, end) in enumerate(zip(boxes.tolist(), ends.tolist(), strict=True)):
        # A negative start would count from the far border.
        left, top, right, bottom = (max(edge, 0) for edge in box)
        part = frame[top:bottom, left:right]
        if part.size:
            seen = _uncovered(part, above[first:end], left, top) if end > first else None
            counts[row] = cv2.calcHist([part], _CHANNELS, seen, _COUNTS, _RANGES).ravel()
        first = end
    return counts


def _uncovered(part: Frame, covers: list[list[int]], left: int, top: int) -> npt.NDArray[np.uint8]:
    """Mask of the pixels of a part of a frame, from `left` and `top`, that no box covers."""
    seen = np.ones(part.shape[:2], np.uint8)
    for x, y, right, bottom in covers:
        rows = slice(max(y - top, 0), max(bottom - top, 0))
        seen[rows, max(x - left, 0) : max(right - left, 0)] = 0
    return seen
