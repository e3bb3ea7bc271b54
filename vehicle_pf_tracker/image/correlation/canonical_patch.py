# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The surroundings of a target, resampled so that the target has a canonical size.

What is measured there costs the same however large the target is in the frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.correlation.affine_sampling import sampled

_REDUCED_FROM = 1.7
"""Frame px per canonical px from which the frame is averaged first: bilinear sampling, which
reads two px an axis, would soon skip some, and the patch shimmer as the target moves."""

_SPARSE_FROM = 4
"""Frame px per canonical px from which not all px are read: the cost would grow with the target.
A choice: half of those of a block are left, 8 of 16."""

_Pair: TypeAlias = tuple[float, float]
"""Two numbers, along x and y."""


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """A resampled square piece of a frame.

    Attributes
    ----------
    image : (side, side, 3) array of uint8
        RGB.
    grey : (side, side) array of uint8
        Luminance of the patch.
    centre : (2,) array
        Point of the frame that the patch's centre shows, px.
    zoom : (2,) array
        Canonical px per px of the frame, along x and y.
    """

    image: Frame
    grey: npt.NDArray[np.uint8]
    centre: Array
    zoom: Array

    @property
    def side(self) -> int:
        """Side in canonical px."""
        return len(self.grey)

    def middle(self, side: int) -> Patch:
        """Cut out the middle of the patch."""
        margin = (self.side - side) // 2
        part = slice(margin, margin + side)
        return Patch(self.image[part, part], self.grey[part, part], self.centre, self.zoom)

    def to_patch(self, positions: Array) -> Array:
        """Positions (..., 2) in px of the frame as continuous px of the patch."""
        return np.asarray((positions - self.centre) * self.zoom + self.side / 2)

    def to_frame(self, positions: Array) -> Array:
        """Positions (..., 2) in continuous px of the patch as px of the frame."""
        return np.asarray((positions - self.side / 2) / self.zoom + self.centre)


def cut_patch(frame: Frame, centre: Array, zoom: Array, side: int) -> Patch:
    """Resample what lies around `centre`; beyond the border its outermost pixels are repeated.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    centre, zoom : (2,) arrays
        See `Patch`.
    side : int
        Side of the patch in canonical px.
    """
    image = cut_image(frame, centre, zoom, (side, side))
    grey = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    return Patch(image, np.asarray(grey, np.uint8), centre, zoom)


def cut_image(frame: Frame, centre: Array, zoom: Array, size: tuple[int, int]) -> Frame:
    """Resample a piece of this width and height; see `cut_patch`."""
    # In scalars, which are quicker than arrays of two.
    middle_x, middle_y = centre.tolist()
    across, down = (1 / factor for factor in zoom.tolist())
    # The affine map from pixel indices of the patch to those of the frame, x and y.
    # Pixel centres of OpenCV are integers, those of this package halves.
    x = middle_x - size[0] / 2 * across + 0.5 * across - 0.5
    y = middle_y - size[1] / 2 * down + 0.5 * down - 0.5
    # By the lesser zoom: averaging more along the other axis would blur the target.
    reduction = max(int(min(across, down) + 2 - _REDUCED_FROM), 1)
    # The affine map then starts from the reduced piece: its px are blocks of the frame.
    if reduction > 1:
        sides = size[0] * across, size[1] * down
        frame, (left, top), (columns, rows) = _reduced(
            frame, (middle_x, middle_y), sides, reduction
        )
        x = (x - left + 0.5) / columns - 0.5
        y = (y - top + 0.5) / rows - 0.5
        across /= columns
        down /= rows
    return sampled(frame, (across, x), (down, y), size)


def _reduced(frame: Frame, centre: _Pair, size: _Pair, factor: int) -> tuple[Frame, _Pair, _Pair]:
    """Average blocks of `factor` px around `centre`.

    Returns
    -------
    small : (h, w, 3) array
        The averages.
    corner : (float, float)
        First px that was averaged.
    factors : (float, float)
        Px of the frame in one of `small`, along x and y.
    """
    width, height = frame_size(frame)
    # Two columns of each block are averaged below, so that it has to be even.
    factor -= factor % 2 if factor >= _SPARSE_FROM else 0
    left, right = _ends(centre[0], size[0], width, factor)
    top, bottom = _ends(centre[1], size[1], height, factor)
    columns = max((right - left) // factor, 1)
    rows = max((bottom - top) // factor, 1)
    # One block more on each side, since bilinear sampling reads the neighbour.
    piece = frame[top : top + rows * factor, left : left + columns * factor]
    if factor >= _SPARSE_FROM and min(piece.shape[:2]) >= factor:
        return _sparsely_reduced(piece, (left, top), factor)
    small = cv2.resize(piece, (columns, rows), interpolation=cv2.INTER_AREA)
    return np.asarray(small, np.uint8), (left, top), (factor, factor)


def _ends(middle: float, side: float, length: int, factor: int) -> tuple[int, int]:
    """First px, and the one after the last, to average along an axis of `length` px."""
    first = min(max(math.floor(middle - side / 2 - factor), 0), max(length - factor, 0))
    return first, min(math.ceil(middle + side / 2 + factor), length)


def _sparsely_reduced(piece: Frame, corner: _Pair, factor: int) -> tuple[Frame, _Pair, _Pair]:
    """Average 4 x 2 px of each block of an even `factor`, in two columns."""
    half = factor // 2
    height, width = piece.shape[:2]
    sparse = piece[half // 2 :: half]
    size = 2 * (width // factor), height // factor
    small = cv2.resize(sparse, size, interpolation=cv2.INTER_LINEAR)
    # The middle of the two rows that are read is not always that of the block.
    top = corner[1] + (half // 2 + 0.5 - half / 2)
    return np.asarray(small, np.uint8), (corner[0], top), (half, factor)
