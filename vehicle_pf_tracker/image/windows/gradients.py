# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The edge feature of P2: directions of the gradient at edge points (section III-C)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.windows.bin_counting import covered_region
from vehicle_pf_tracker.image.windows.window import (
    Counted,
    CountedFeature,
    Grey,
    Positions,
    Window,
    bounds,
    to_grey,
)

Strengths: TypeAlias = npt.NDArray[np.float32]
"""Squared magnitude of the gradient; integers below 2**24, so exact."""

DIRECTION_BINS = 64
"""Bins of the gradient's direction (P2, section III-C)."""


def gradients_of(grey: Grey) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.int16]]:
    """Gradient of equation 6 along x and y, the image mirrored at its border."""
    gx, gy = (cv2.Sobel(grey, cv2.CV_16S, dx, 1 - dx, ksize=3) for dx in (1, 0))
    return np.asarray(gx, np.int16), np.asarray(gy, np.int16)


def squared_strength(gx: npt.NDArray[Any], gy: npt.NDArray[Any]) -> Strengths:
    """Squared magnitude of equation 7, in grey levels squared."""
    gx, gy = gx.astype(np.float32), gy.astype(np.float32)
    return np.asarray(gx * gx + gy * gy)


def direction_bins(
    gx: npt.NDArray[Any], gy: npt.NDArray[Any], *, signed: bool
) -> npt.NDArray[np.intp]:
    """Bin 0 to 63 of the direction in the image (x to the right, y down).

    Parameters
    ----------
    gx, gy : arrays of one shape
        Integers; where both are zero the bin means nothing.
    signed : bool
        False takes ``atan(gy / gx)``, which knows no opposite directions.

    Returns
    -------
    array
        -180 degrees is bin 0, 0 degrees the lower end of bin 32; 180 degrees is -180.
    """
    if not signed:
        # The printed atan has the range of half a turn; of a vertical gradient one sign is chosen.
        fold = (gx < 0) | ((gx == 0) & (gy < 0))
        gx, gy = np.where(fold, -gx, gx), np.where(fold, -gy, gy)
    turns = np.arctan2(gy.astype(np.float64), gx.astype(np.float64)) / (2 * np.pi) + 0.5
    return np.floor(turns * DIRECTION_BINS).astype(np.intp) % DIRECTION_BINS


@dataclass(frozen=True)
class GradientDirections(CountedFeature):
    """64 bins of gradient direction, -180 to 180 degrees, of a window's edge points.

    Parameters
    ----------
    threshold : float
        Edge points have at least this share of the window's strongest gradient (printed: 0.8;
        interpretation 14).
    in_frame : bool
        Take the gradient in the frame; False takes it in each window by itself, mirrored at its
        border, as printed (interpretation 14).
    signed : bool
        Distinguish dark-to-light from light-to-dark; False takes the printed ``atan``, which folds
        opposite directions into the middle 32 bins (interpretation 13).
    floor : float
        Gradient that an edge point has at least (a step of one grey level makes 4). Without one, a
        window of nothing but noise is full of edge points.
    """

    threshold: float = 0.3
    in_frame: bool = True
    signed: bool = True
    floor: float = 0.0

    bins = DIRECTION_BINS

    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count windows; see `CountedFeature.counts`."""
        # One pixel more makes every gradient in the windows that of the whole frame.
        region, windows = covered_region(frame, bounds(frame, positions, window), margin=1)
        grey = to_grey(region)
        of_frame = self._directions(grey)
        counts = np.zeros((len(positions), self.bins), np.intp)
        for row, (left, top, right, bottom) in enumerate(zip(*windows, strict=True)):
            inside = slice(top, bottom), slice(left, right)
            if self.in_frame:
                strength = of_frame[0][inside]
                bins = of_frame[1][inside]
            else:
                strength, bins = self._directions(grey[inside].copy())
            # The limit is relative: a window of faint edges has edge points as well as one of
            # strong ones.
            peak = strength.max()
            if peak > 0:  # else nothing is an edge point
                limit = max(np.float32(self.threshold) ** 2 * peak, np.float32(self.floor) ** 2)
                counts[row] = np.bincount(bins[strength >= limit], minlength=self.bins)
        # The last digit of a sum depends on the layout: these keep estimates what they were.
        chosen = np.asarray(counts[:, active], order="C" if self.in_frame else "K")
        return Counted(chosen, counts.sum(axis=1))

    def _directions(self, grey: Grey) -> tuple[Strengths, npt.NDArray[np.intp]]:
        """Squared strength and direction at each pixel, the image mirrored at its border."""
        gx, gy = gradients_of(grey)
        return squared_strength(gx, gy), direction_bins(gx, gy, signed=self.signed)
