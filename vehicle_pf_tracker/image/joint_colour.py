"""The colour feature of P1 and P3: the joint RGB histogram of a window."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.colour import bin_count, bin_indices
from vehicle_pf_tracker.image.window import Positions, Window, bounds
from vehicle_pf_tracker.image.window_feature import Counted, CountedFeature
from vehicle_pf_tracker.image.window_sums import areas, bin_counts, covered_region


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
