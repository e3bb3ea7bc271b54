# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of boxes of any size, in numba."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.kernels.numba_types import (
    COUNTS,
    RECTANGLES,
    RGB_IMAGE,
    Extent,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined
from vehicle_pf_tracker.image.windows.box_colours import Counts, Rectangles

Mask: TypeAlias = npt.NDArray[np.uint8]


@inlined
def mark_shown(
    shown: Mask, extent: Extent, y: int, covers: Rectangles, which: tuple[int, int]
) -> None:
    """Mark in a row's pixels, (W,), those of an extent that no cover from one on to another has."""
    left, _, right, _ = extent
    for x in range(left, right):
        shown[x] = 1
    for k in range(which[0], which[1]):
        if covers[k, 1] <= y < covers[k, 3]:
            for x in range(max(left, covers[k, 0]), min(right, covers[k, 2])):
                shown[x] = 0


@compiled(COUNTS, RGB_IMAGE, RECTANGLES, RECTANGLES, "int64[::1]")
def count_colours(frame: Frame, boxes: Rectangles, covers: Rectangles, ends: Rectangles) -> Counts:
    """Count the pixels of each colour in boxes; see `image.windows.box_colours`."""
    height, width, channels = frame.shape
    if channels != 3 or boxes.shape[1] != 4 or covers.shape[1] != 4 or len(ends) != len(boxes):
        raise IndexError("the arrays are not those of boxes in a frame of colours")
    counts = np.zeros((len(boxes), 64), np.int32)
    shown = np.empty(width, np.uint8)
    first = 0
    for i in range(len(boxes)):
        if not first <= ends[i] <= len(covers):
            raise IndexError("there are other covers than the boxes have")
        left = max(boxes[i, 0], 0)
        top = max(boxes[i, 1], 0)
        right = min(boxes[i, 2], width)
        bottom = min(boxes[i, 3], height)
        for y in range(top, bottom):
            mark_shown(shown, (left, top, right, bottom), y, covers, (first, ends[i]))
            for x in range(left, right):
                # The upper two bits of each channel.
                red = frame[y, x, 0] >> 6
                green = frame[y, x, 1] >> 6
                blue = frame[y, x, 2] >> 6
                counts[i, red << 4 | green << 2 | blue] += shown[x]
        first = ends[i]
    return counts
