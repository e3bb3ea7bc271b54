# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Windows, and features that describe each window by a histogram.

A window is the rectangle of pixels around a position from which features are taken. It has
``(2 w_x + 1) x (2 w_y + 1)`` pixels, as in P1; over the border of the image it keeps the pixels
that exist (interpretation 24).
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.windows.similarity import Reference, bhattacharyya_coefficient

Positions = npt.NDArray[np.float64]
Centres = npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Window:
    """Size of a window: its half sizes w_x and w_y in px."""

    half_width: int
    half_height: int

    @classmethod
    def of_size(cls, width: float, height: float) -> Window:
        """Make the window nearest to a box of `width` x `height` px, half rounded to even."""
        # Never less than its middle pixel.
        return cls(max(round((width - 1) / 2), 0), max(round((height - 1) / 2), 0))

    @property
    def width(self) -> int:
        """Full width in px, always odd."""
        return 2 * self.half_width + 1

    @property
    def height(self) -> int:
        """Full height in px, always odd."""
        return 2 * self.half_height + 1


class Bounds(NamedTuple):
    """Pixel rectangles, ends exclusive; scalars or arrays of one shape."""

    left: npt.NDArray[np.intp]
    top: npt.NDArray[np.intp]
    right: npt.NDArray[np.intp]
    bottom: npt.NDArray[np.intp]


def centres(positions: Positions) -> Centres:
    """Index of the pixel that each position lies in, half rounded to even.

    Parameters
    ----------
    positions : (..., 2) array
        x, y in continuous px (the centre of pixel i is i + 0.5).
    """
    # Half to even, as `round` and numba do: all kernels choose the same pixel.
    return np.rint(np.asarray(positions) - 0.5).astype(np.intp)


def bounds(frame: Frame, positions: Positions, window: Window) -> Bounds:
    """Pixel rectangles of the windows at `positions`, cut at the border of `frame`.

    Parameters
    ----------
    frame : (H, W, 3) array
        Only its size is used.
    positions : (N, 2) array
        Window centres in continuous px; moved inside the image if they are not, so that every
        window keeps at least its middle pixel.
    window : Window
        Size of all windows.

    Returns
    -------
    Bounds
        Arrays of shape (N,); every rectangle has at least one pixel.
    """
    # Moved inside first, cut afterwards: so every window keeps its middle pixel.
    width, height = frame_size(frame)
    pixel = centres(positions)
    # np.clip does the same, four times slower on arrays of this size.
    x = np.minimum(np.maximum(pixel[..., 0], 0), width - 1)
    y = np.minimum(np.maximum(pixel[..., 1], 0), height - 1)
    return Bounds(
        # Ends are exclusive, hence one more on the right and below.
        np.maximum(x - window.half_width, 0),
        np.maximum(y - window.half_height, 0),
        np.minimum(x + window.half_width + 1, width),
        np.minimum(y + window.half_height + 1, height),
    )


def bounds_of_one(
    frame: Frame, position: tuple[float, float], window: Window
) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of one window; `bounds` for a position (x, y) without arrays."""
    width, height = frame_size(frame)
    # `round` takes halves to even numbers, as `np.rint` does.
    x = min(max(round(position[0] - 0.5), 0), width - 1)
    y = min(max(round(position[1] - 0.5), 0), height - 1)
    return (
        max(x - window.half_width, 0),
        max(y - window.half_height, 0),
        min(x + window.half_width + 1, width),
        min(y + window.half_height + 1, height),
    )


def keep_inside(frame: Frame, positions: Positions) -> Positions:
    """Clip positions so that each lies on a pixel of `frame`, shape (..., 2)."""
    # One in scalars, which are quicker than arrays of two.
    if positions.ndim == 1:
        (x, y), (width, height) = positions.tolist(), frame_size(frame)
        return np.array([min(max(x, 0.5), width - 0.5), min(max(y, 0.5), height - 0.5)])
    # np.clip does the same, slower.
    return np.minimum(np.maximum(positions, 0.5), _last_middle(*frame_size(frame)))


@functools.lru_cache(maxsize=8)
def _last_middle(width: int, height: int) -> npt.NDArray[np.float64]:
    """Middle of the last pixel of images of a size, px; made once for all images of a camera."""
    # Continuous px begin at a pixel's corner.
    return np.array([width - 0.5, height - 0.5])


def is_outside(frame: Frame, x: float, y: float) -> bool:
    """Test whether a position lies beyond the border of `frame`."""
    width, height = frame_size(frame)
    # The border itself is inside: the last pixel ends there.
    return x < 0 or y < 0 or x > width or y > height


Grey: TypeAlias = npt.NDArray[np.uint8]
Histograms: TypeAlias = npt.NDArray[np.float64]
Coefficients: TypeAlias = npt.NDArray[np.float64]


class Counted(NamedTuple):
    """Counts of chosen bins (N, K), and of all bins together (N,)."""

    bins: npt.NDArray[Any]
    totals: npt.NDArray[Any]

    @property
    def histograms(self) -> Histograms:
        """Counts relative to all; zero where nothing was counted."""
        # A window without anything to count is divided by 1: all zero, and similar to nothing.
        return np.asarray(self.bins / np.maximum(self.totals, 1)[:, np.newaxis])

    def coefficients(self, values: Histograms) -> Coefficients:
        """Bhattacharyya coefficient of each row with a reference's `values` (K,), shape (N,)."""
        # The root of the total comes out of the sum, so that only active bins are divided.
        overlap = np.sqrt(self.bins * values).sum(axis=1)
        return np.asarray(np.minimum(overlap / np.sqrt(np.maximum(self.totals, 1)), 1.0))


class WindowFeature(ABC):
    """A feature that describes each window by a histogram."""

    @property
    @abstractmethod
    def bins(self) -> int:
        """Number of bins."""

    @abstractmethod
    def histograms(self, frame: Frame, positions: Positions, window: Window) -> Histograms:
        """Describe windows.

        Parameters
        ----------
        frame : (H, W, 3) array
            RGB.
        positions : (N, 2) array
            Window centres in px.
        window : Window
            Size of all windows; over the border the pixels that exist count.

        Returns
        -------
        (N, bins) array
            Each row sums to one, or is all zero where a window has nothing to count.
        """

    def similarity(
        self, frame: Frame, positions: Positions, window: Window, reference: Reference
    ) -> Coefficients:
        """Bhattacharyya coefficient of each window with `reference`, shape (N,), 0 to 1.

        Parameters
        ----------
        frame, positions, window
            As in `histograms`.
        reference : Reference
            One histogram; all zero is similar to nothing.
        """
        histograms = self.histograms(frame, positions, window)
        return bhattacharyya_coefficient(histograms, reference.histogram)


class CountedFeature(WindowFeature):
    """A feature whose histograms count pixels, so that only some bins need be counted."""

    @abstractmethod
    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count the ascending bins `active`, and all bins together."""

    def histograms(self, frame: Frame, positions: Positions, window: Window) -> Histograms:
        """Describe windows; see `WindowFeature.histograms`."""
        # All bins are active where no reference says which count.
        return self.counts(frame, positions, window, np.arange(self.bins)).histograms

    def similarity(
        self, frame: Frame, positions: Positions, window: Window, reference: Reference
    ) -> Coefficients:
        """Compare windows by the bins of `reference` alone; see `WindowFeature.similarity`."""
        # A reference without a bin is similar to nothing; there is nothing to count either.
        if len(reference.active) == 0:
            return np.zeros(len(positions))
        counted = self.counts(frame, positions, window, reference.active)
        return counted.coefficients(reference.values)


def to_grey(pixels: Frame) -> Grey:
    """Grey levels of RGB pixels, shape (H, W)."""
    return np.asarray(cv2.cvtColor(np.ascontiguousarray(pixels), cv2.COLOR_RGB2GRAY), np.uint8)
