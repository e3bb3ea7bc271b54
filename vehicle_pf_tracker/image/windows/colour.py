# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colour features: the joint RGB histogram of P1 and P3, and the three channel histograms of P2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.windows.bin_counting import areas, bin_counts, covered_region
from vehicle_pf_tracker.image.windows.window import (
    Counted,
    CountedFeature,
    Positions,
    Window,
    bounds,
)

BinIndices = npt.NDArray[np.uint16]


CHANNEL_BINS = 21
"""Bins of each channel (P2, section III-C)."""


def bin_count(bits: int) -> int:
    """Count the bins of a joint histogram with `bits` bits a channel (1 to 5)."""
    return 1 << (3 * bits)


def bin_indices(pixels: Frame, bits: int) -> BinIndices:
    """Joint bin of every pixel: red in the highest bits, blue in the lowest.

    Parameters
    ----------
    pixels : (H, W, 3) array
        RGB.
    bits : int
        Bits kept of each channel, 1 to 5.

    Returns
    -------
    (H, W) array of uint16
        From 0 to ``bin_count(bits) - 1``.
    """
    # The highest bits: bins of one width, and no division.
    levels = (pixels >> np.uint8(8 - bits)).astype(np.uint16)
    return np.asarray(
        (levels[..., 0] << np.uint16(2 * bits))
        | (levels[..., 1] << np.uint16(bits))
        | levels[..., 2]
    )


@dataclass(frozen=True)
class JointColour(CountedFeature):
    """``8 ** bits`` bins, red in the highest bits of their number (P1, section III-C).

    Parameters
    ----------
    bits : int
        Bits kept of each channel, 1 to 5.
    """

    bits: int = 3

    @property
    def bins(self) -> int:
        """Number of bins."""
        return bin_count(self.bits)

    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count windows; see `CountedFeature.counts`."""
        region, windows = covered_region(frame, bounds(frame, positions, window))
        counts = bin_counts(bin_indices(region, self.bits), active, self.bins, windows)
        return Counted(counts, areas(windows))


@dataclass(frozen=True)
class RgbMarginals(CountedFeature):
    """63 bins: red 0 to 20, green 21 to 41, blue 42 to 62 (P2, III-C; interpretation 20)."""

    bins = 3 * CHANNEL_BINS

    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count windows; see `CountedFeature.counts`."""
        region, windows = covered_region(frame, bounds(frame, positions, window))
        levels = marginal_bins(region)
        # A pixel has a bin of each channel: three counts of 21 bins, not one of 63.
        # Active bins ascend, so that those of a channel stand together.
        edges = np.searchsorted(active, [0, CHANNEL_BINS, 2 * CHANNEL_BINS, self.bins])
        counts = [
            bin_counts(
                levels[..., channel],
                active[edges[channel] : edges[channel + 1]] - channel * CHANNEL_BINS,
                CHANNEL_BINS,
                windows,
            )
            for channel in range(3)
        ]
        return Counted(np.concatenate(counts, axis=1), 3 * areas(windows))


def marginal_bins(pixels: Frame) -> npt.NDArray[np.uint16]:
    """Bin 0 to 20 of every value, ``floor(v * 21 / 256)``."""
    # In integers, so that every implementation has the same bin; 255 * 21 fits 16 bits.
    return np.asarray((pixels.astype(np.uint16) * np.uint16(CHANNEL_BINS)) >> np.uint16(8))
