# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The surroundings of a target, resampled so that the target has a canonical size.

What is measured there costs the same however large the target is in the frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size

_REDUCED_FROM = 1.7
"""Frame px per canonical px from which the frame is averaged first: bilinear sampling, which
reads two px an axis, would soon skip some, and the patch shimmer as the target moves."""

_SPARSE_FROM = 4
"""Frame px per canonical px from which not all px are read: the cost would grow with the target.
A choice: half of those of a block are left, 8 of 16."""


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
    step = 1 / zoom
    sides = np.array(size)
    # Row of the affine map from pixel indices of the patch to those of the frame, x and y.
    # Pixel centres of OpenCV are integers, those of this package halves.
    first = centre - sides / 2 * step + 0.5 * step - 0.5
    # By the lesser zoom: averaging more along the other axis would blur the target.
    reduction = max(int(min(step.tolist()) + 2 - _REDUCED_FROM), 1)
    # The affine map then starts from the reduced piece: its px are blocks of the frame.
    if reduction > 1:
        frame, corner, factors = _reduced(frame, centre, sides * step, reduction)
        first = (first - corner + 0.5) / factors - 0.5
        step = step / factors
    across, down = step.tolist()
    x, y = first.tolist()
    matrix = np.array([[across, 0.0, x], [0.0, down, y]])
    image = cv2.warpAffine(
        frame,
        matrix,
        size,
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return np.asarray(image, np.uint8)


def _reduced(frame: Frame, centre: Array, size: Array, factor: int) -> tuple[Frame, Array, Array]:
    """Average blocks of `factor` px around `centre`.

    Returns
    -------
    small : (h, w, 3) array
        The averages.
    corner : (2,) array
        First px that was averaged.
    factors : (2,) array
        Px of the frame in one of `small`, along x and y.
    """
    width, height = frame_size(frame)
    # Two columns of each block are averaged below, so that it has to be even.
    factor -= factor % 2 if factor >= _SPARSE_FROM else 0
    low = centre - size / 2 - factor
    high = centre + size / 2 + factor
    left = min(max(math.floor(low[0]), 0), max(width - factor, 0))
    top = min(max(math.floor(low[1]), 0), max(height - factor, 0))
    columns = max(min(math.ceil(high[0]) - left, width - left) // factor, 1)
    rows = max(min(math.ceil(high[1]) - top, height - top) // factor, 1)
    # One block more on each side, since bilinear sampling reads the neighbour.
    piece = frame[top : top + rows * factor, left : left + columns * factor]
    corner = np.array([left, top], float)
    if factor >= _SPARSE_FROM and min(piece.shape[:2]) >= factor:
        return _sparsely_reduced(piece, corner, factor)
    small = cv2.resize(piece, (columns, rows), interpolation=cv2.INTER_AREA)
    return np.asarray(small, np.uint8), corner, np.array([factor, factor], float)


def _sparsely_reduced(piece: Frame, corner: Array, factor: int) -> tuple[Frame, Array, Array]:
    """Average 4 x 2 px of each block of an even `factor`, in two columns."""
    half = factor // 2
    height, width = piece.shape[:2]
    sparse = piece[half // 2 :: half]
    size = 2 * (width // factor), height // factor
    small = cv2.resize(sparse, size, interpolation=cv2.INTER_LINEAR)
    # The middle of the two rows that are read is not always that of the block.
    corner = corner + np.array([0, half // 2 + 0.5 - half / 2])
    return np.asarray(small, np.uint8), corner, np.array([half, factor], float)
