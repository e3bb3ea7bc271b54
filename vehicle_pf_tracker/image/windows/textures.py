# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The texture features that P2 tried: co-occurrences, Haralick statistics, binary patterns."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.windows.bin_counting import areas, bin_counts, covered_region
from vehicle_pf_tracker.image.windows.window import (
    Bounds,
    Counted,
    CountedFeature,
    Grey,
    Histograms,
    Positions,
    Window,
    WindowFeature,
    bounds,
    to_grey,
)

LEVELS = 8
"""Grey levels of co-occurrences (P2, section III-D): three bits of eight."""


@dataclass(frozen=True)
class Cooccurrence(CountedFeature):
    """64 bins, ``8 * level + level of the pixel to the east``, pairs within the window.

    References
    ----------
    P2, section III-D: 8 x 8 grey levels, offset of one pixel, from left to right.
    """

    bins = LEVELS * LEVELS

    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count windows; see `CountedFeature.counts`."""
        region, windows = covered_region(frame, bounds(frame, positions, window))
        # The last column of a window has no eastern neighbour in it.
        pairs = Bounds(windows.left, windows.top, windows.right - 1, windows.bottom)
        counts = bin_counts(pair_bins(to_grey(region)), active, self.bins, pairs)
        return Counted(counts, areas(pairs))


def pair_bins(grey: Grey) -> Grey:
    """Bin of each pixel with its eastern neighbour, shape (H, W - 1)."""
    # Three bits of level: 8 x 8 pairs, the paper's size.
    levels = grey >> np.uint8(5)
    return np.asarray((levels[:, :-1] << np.uint8(3)) | levels[:, 1:])


DESCRIPTORS = ("maximum probability", "contrast", "homogeneity", "uniformity", "entropy")
"""Statistics of a co-occurrence matrix (P2, section III-D)."""


@dataclass(frozen=True)
class HaralickStatistics(WindowFeature):
    """Ten bins: each of the `DESCRIPTORS`, scaled to 0..1, and its complement to 1.

    P2 does not define how vectors of statistics are compared. Normalising the vector itself would
    keep only the ratios of quantities of different kinds; here each descriptor is a histogram of
    two bins, so that the coefficient is the mean of the descriptors' own and 1 only where all
    agree.

    References
    ----------
    P2, section III-D.
    """

    bins = 2 * len(DESCRIPTORS)

    def histograms(self, frame: Frame, positions: Positions, window: Window) -> Histograms:
        """Describe windows; see `WindowFeature.histograms`."""
        matrices = Cooccurrence().histograms(frame, positions, window)
        values = descriptors(matrices)
        # A descriptor and its complement are a histogram of two bins, whose coefficient is 1 only
        # where they agree.
        pairs = np.stack([values, 1.0 - values], axis=2).reshape(len(values), self.bins)
        # A window of one column has no pair, and is similar to nothing.
        measured = matrices.any(axis=1, keepdims=True)
        return np.asarray(np.where(measured, pairs / len(DESCRIPTORS), 0.0))


def descriptors(matrices: Array) -> Array:
    """Scaled statistics of co-occurrence matrices.

    Parameters
    ----------
    matrices : (N, 64) array
        Normalised histograms of `Cooccurrence`.

    Returns
    -------
    (N, 5) array
        In the order of `DESCRIPTORS`. Contrast is divided by its largest value 49, entropy by
        ``log 64``; the others are 0 to 1 by nature.
    """
    first, second = np.divmod(np.arange(LEVELS * LEVELS), LEVELS)
    difference = np.abs(first - second)
    # p log p of an empty bin is 0: log 1 stands in for log 0.
    logarithms = np.log(np.where(matrices > 0, matrices, 1.0))
    values = [
        matrices.max(axis=1),
        (matrices * np.square(difference)).sum(axis=1) / (LEVELS - 1) ** 2,
        (matrices / (1.0 + difference)).sum(axis=1),
        np.square(matrices).sum(axis=1),
        -(matrices * logarithms).sum(axis=1) / np.log(LEVELS * LEVELS),
    ]
    return np.asarray(np.clip(np.column_stack(values), 0.0, 1.0))


NEIGHBOURS = ((0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1))
"""Column and row of each bit's neighbour around (1, 1): clockwise from the top left."""


@dataclass(frozen=True)
class BinaryPatterns(CountedFeature):
    """256 bins, one for each pattern of neighbours not darker than the pixel (P2, III-D).

    Neighbours are those in the frame; at its border the image is mirrored.
    """

    bins = 256

    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count windows; see `CountedFeature.counts`."""
        region, windows = covered_region(frame, bounds(frame, positions, window), margin=1)
        # With the margin the neighbours of a window's rim are those in the frame.
        counts = bin_counts(patterns(to_grey(region)), active, self.bins, windows)
        return Counted(counts, areas(windows))


def patterns(grey: Grey) -> Grey:
    """Pattern of every pixel, shape (H, W): bit `i` is set where `NEIGHBOURS[i]` >= the pixel."""
    height, width = grey.shape
    # Mirrored without repeating the border: repeated pixels would all count as not darker.
    padded = np.asarray(cv2.copyMakeBorder(grey, 1, 1, 1, 1, cv2.BORDER_REFLECT_101), np.uint8)
    codes = np.zeros_like(grey)
    for bit, (column, row) in enumerate(NEIGHBOURS):
        neighbour = padded[row : row + height, column : column + width]
        codes |= (neighbour >= grey).astype(np.uint8) << np.uint8(bit)
    return codes
