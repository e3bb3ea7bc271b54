"""The texture feature that P2 chose: the grey-level co-occurrence matrix of neighbours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.window import Bounds, Positions, Window, bounds
from vehicle_pf_tracker.image.window_feature import Counted, CountedFeature, Grey, to_grey
from vehicle_pf_tracker.image.window_sums import areas, bin_counts, covered_region

LEVELS = 8


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
        pairs = Bounds(windows.left, windows.top, windows.right - 1, windows.bottom)
        counts = bin_counts(pair_bins(to_grey(region)), active, self.bins, pairs)
        return Counted(counts, areas(pairs))


def pair_bins(grey: Grey) -> Grey:
    """Bin of each pixel with its eastern neighbour, shape (H, W - 1)."""
    levels = grey >> np.uint8(5)
    return np.asarray((levels[:, :-1] << np.uint8(3)) | levels[:, 1:])
