# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bilinear sampling of a piece of a frame, scaled and shifted.

OpenCV samples four channels in less than half of the time of three (5.0, 128 x 128 px: 48 and
127 us), to the same values. A large piece is therefore copied into an image of four channels first.
"""

from __future__ import annotations

import math
import threading
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, frame_size

_LEAST_PX = 64 * 64
"""Px of the result from which the copies cost less than they save: with 56 x 40 they are even."""
_MARGIN = 2
"""Px copied beyond those that are sampled: bilinear sampling reads the next one too, and places are
rounded to float32."""

Axis = tuple[float, float]
"""Scale and shift of an axis: index `i` of the result shows place ``scale * i + shift``."""


class _Scratch(threading.local):
    """Image of four channels, of a frame's size; one for each thread.

    It is as large as the frame, since OpenCV rounds places by their distance from the frame's
    corner. Only the pieces that were copied are ever touched, and take memory.
    """

    def __init__(self) -> None:
        self._image: npt.NDArray[np.uint8] = np.empty((0, 0, 4), np.uint8)

    def of_size(self, width: int, height: int) -> npt.NDArray[np.uint8]:
        """Return the image; what an earlier call has left in it may be anything."""
        if self._image.shape[:2] != (height, width):
            self._image = np.empty((height, width, 4), np.uint8)
        return self._image


_scratch = _Scratch()


def sampled(frame: Frame, x: Axis, y: Axis, size: tuple[int, int]) -> Frame:
    """Sample a piece of a frame; beyond the border its outermost pixels are repeated.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    x, y : (float, float)
        See `Axis`; places count pixel centres, as OpenCV does.
    size : (int, int)
        Width and height of the result, px.
    """
    matrix = np.array([[x[0], 0.0, x[1]], [0.0, y[0], y[1]]])
    if size[0] * size[1] < _LEAST_PX:
        return _warped(frame, matrix, size)
    width, height = frame_size(frame)
    rows = _read(y, size[1], height)
    columns = _read(x, size[0], width)
    wide = _scratch.of_size(width, height)
    cv2.cvtColor(frame[rows, columns], cv2.COLOR_RGB2RGBA, dst=wide[rows, columns])
    return np.asarray(cv2.cvtColor(_warped(wide, matrix, size), cv2.COLOR_RGBA2RGB), np.uint8)


def _warped(image: npt.NDArray[np.uint8], matrix: Any, size: tuple[int, int]) -> Frame:
    warped = cv2.warpAffine(
        image,
        matrix,
        size,
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return np.asarray(warped, np.uint8)


def _read(axis: Axis, count: int, length: int) -> slice:
    """Px along an axis of a frame that are read; at least its first or last one."""
    scale, first = axis
    low = math.floor(first) - _MARGIN
    high = math.ceil(first + scale * (count - 1)) + _MARGIN
    return slice(min(max(low, 0), length - 1), min(max(high + 1, 1), length))
