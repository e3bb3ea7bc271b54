"""The colour feature of P2: three histograms of 21 bins, one a channel, in a row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.window import Positions, Window, bounds
from vehicle_pf_tracker.image.window_feature import Counted, CountedFeature
from vehicle_pf_tracker.image.window_sums import areas, bin_counts, covered_region

CHANNEL_BINS = 21


@dataclass(frozen=True)
class RgbMarginals(CountedFeature):
    """63 bins: red 0 to 20, green 21 to 41, blue 42 to 62 (P2, section III-C; READINGS 20)."""

    bins = 3 * CHANNEL_BINS

    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count windows; see `CountedFeature.counts`."""
        region, windows = covered_region(frame, bounds(frame, positions, window))
        levels = marginal_bins(region)
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
    return np.asarray((pixels.astype(np.uint16) * np.uint16(CHANNEL_BINS)) >> np.uint16(8))
