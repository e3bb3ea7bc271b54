"""A texture feature that P2 tried and left: local binary patterns."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.window import Positions, Window, bounds
from vehicle_pf_tracker.image.window_feature import Counted, CountedFeature, Grey, to_grey
from vehicle_pf_tracker.image.window_sums import areas, bin_counts, covered_region

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
        counts = bin_counts(patterns(to_grey(region)), active, self.bins, windows)
        return Counted(counts, areas(windows))


def patterns(grey: Grey) -> Grey:
    """Pattern of every pixel, shape (H, W): bit `i` is set where `NEIGHBOURS[i]` >= the pixel."""
    height, width = grey.shape
    padded = np.asarray(cv2.copyMakeBorder(grey, 1, 1, 1, 1, cv2.BORDER_REFLECT_101), np.uint8)
    codes = np.zeros_like(grey)
    for bit, (column, row) in enumerate(NEIGHBOURS):
        neighbour = padded[row : row + height, column : column + width]
        codes |= (neighbour >= grey).astype(np.uint8) << np.uint8(bit)
    return codes
