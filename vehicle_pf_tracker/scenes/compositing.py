# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sprites painted over an image at exact sub-pixel positions and sizes, and their coverage.

A sprite keeps the integral of its finely drawn picture, so that the mean over any pixel is four
look-ups, exact for every sub-pixel shift and every scale.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, Position

Image: TypeAlias = npt.NDArray[np.float32]
"""RGB picture while it is composed, shape (height, width, 3), levels 0 to 255."""
Colour: TypeAlias = tuple[float, float, float]
"""Red, green and blue, levels 0 to 255."""


@dataclass(frozen=True, slots=True)
class PixelWindow:
    """The pixels of an image from (left, top) up to, not including, (right, bottom)."""

    left: int
    top: int
    right: int
    bottom: int

    @classmethod
    def of(cls, box: Box, width: int, height: int) -> PixelWindow:
        """Make the window of all pixels of a `width` x `height` px image that `box` touches."""
        corners = box.corners
        return cls.between(corners[0], corners[2], width, height)

    @classmethod
    def between(cls, low: Position, high: Position, width: int, height: int) -> PixelWindow:
        """Make the window of all pixels that the rectangle between two corners touches."""
        # Outwards: a pixel that is touched by a hundredth is one of its pixels.
        left, top = (max(math.floor(side), 0) for side in low)
        return cls(left, top, min(math.ceil(high[0]), width), min(math.ceil(high[1]), height))

    @property
    def empty(self) -> bool:
        """True if there is no pixel in it."""
        return self.left >= self.right or self.top >= self.bottom

    @property
    def slices(self) -> tuple[slice, slice]:
        """Index of these pixels in an image array."""
        return slice(self.top, self.bottom), slice(self.left, self.right)


class Sprite:
    """A picture with opacity that can be painted at any position and size.

    Parameters
    ----------
    colour : array of shape (rows, columns, 3)
        RGB levels 0 to 255, finely drawn; each cell is taken as constant over its area.
    opacity : array of shape (rows, columns)
        0 (nothing there) to 1 (hides what is behind).
    """

    def __init__(self, colour: npt.ArrayLike, opacity: npt.ArrayLike) -> None:
        self._colour = np.asarray(colour)
        self._opacity = np.asarray(opacity)
        self._last: tuple[Box, PixelWindow, Image] | None = None

    @cached_property
    def _integral(self) -> Array:
        """Sums of all cells above and to the left, red, green and blue times opacity, opacity.

        Made when first asked for: the truth needs few of a scene's sprites.
        """
        # Multiplied before it is averaged: else the colour of empty cells would bleed into the rim.
        alpha = self._opacity.astype(np.float64)[..., np.newaxis]
        cells = np.concatenate([self._colour * alpha, alpha], axis=2)
        rows, columns, channels = cells.shape
        integral: Array = np.zeros((rows + 1, columns + 1, channels))
        # In float64: sums of thousands of cells, of which differences are taken.
        np.cumsum(cells.cumsum(axis=0), axis=1, out=integral[1:, 1:])
        return integral

    @classmethod
    def plain(cls, colour: Colour, opacity: float = 1.0) -> Sprite:
        """Make a rectangle of one colour."""
        return cls(np.reshape(colour, (1, 1, 3)), np.full((1, 1), opacity))

    def area(self, box: Box) -> float:
        """Area in px² of the silhouette when the sprite fills `box`."""
        rows = self._integral.shape[0] - 1
        columns = self._integral.shape[1] - 1
        # The last corner of the integral is the sum over all cells.
        return float(self._integral[-1, -1, 3] * box.area / (rows * columns))

    def layer(self, box: Box, window: PixelWindow) -> Image:
        """Mean of the sprite over each pixel of `window` when it fills `box`.

        The last answer is kept, because bridges stand still.

        Returns
        -------
        array of shape (rows, columns, 4)
            Red, green and blue already multiplied with opacity, and opacity.
        """
        if self._last is None or self._last[:2] != (box, window):
            means = self._means(self._integral, box, window).astype(np.float32)
            self._last = box, window, means
        return self._last[2]

    def coverage(self, box: Box, window: PixelWindow) -> Array:
        """Opacity alone of `layer`, shape (rows, columns)."""
        return self._means(self._integral[..., 3], box, window)

    @staticmethod
    def _means(integral: Array, box: Box, window: PixelWindow) -> Array:
        rows = integral.shape[0] - 1
        columns = integral.shape[1] - 1
        # Clipped: beyond the sprite the integral is constant, and its differences there are 0.
        x = (np.arange(window.left, window.right + 1) - box.x) * (columns / box.width)
        y = (np.arange(window.top, window.bottom + 1) - box.y) * (rows / box.height)
        # Between cells the integral is linear in each direction, so that interpolation is exact.
        corners = interpolate(integral, y.clip(0, rows), x.clip(0, columns))
        sums: Array = np.diff(np.diff(corners, axis=0), axis=1)
        # From a sum of cells to a mean over a pixel of 1 px²: a cell covers this many px².
        sums *= box.area / (rows * columns)
        return sums


def interpolate(grid: Array, y: Array, x: Array) -> Array:
    """Bilinear values of `grid` at every (y, x), which is exact for an integral of cells."""
    # The far edge belongs to the last cell, with weight 1: there is no corner after it.
    row = np.minimum(y.astype(np.intp), grid.shape[0] - 2)[:, np.newaxis]
    column = np.minimum(x.astype(np.intp), grid.shape[1] - 2)
    # Channels, if there are any, are all weighted alike.
    depth = (1,) * (grid.ndim - 2)
    down = (y[:, np.newaxis] - row).reshape(-1, 1, *depth)
    right = (x - column).reshape(1, -1, *depth)
    left: Array = grid[row, column] * (1 - down) + grid[row + 1, column] * down
    beyond: Array = grid[row, column + 1] * (1 - down) + grid[row + 1, column + 1] * down
    values: Array = left * (1 - right) + beyond * right
    return values
