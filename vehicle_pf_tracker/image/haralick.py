"""A texture feature that P2 tried and left: statistics of the co-occurrence matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.glcm import LEVELS, Cooccurrence
from vehicle_pf_tracker.image.window import Positions, Window
from vehicle_pf_tracker.image.window_feature import Histograms, WindowFeature

DESCRIPTORS = ("maximum probability", "contrast", "homogeneity", "uniformity", "entropy")


@dataclass(frozen=True)
class HaralickStatistics(WindowFeature):
    """Ten bins: each of the `DESCRIPTORS`, scaled to 0..1, beside what it lacks to 1.

    P2 does not say how a vector of statistics is held against another one. Normalising the vector
    itself would keep only the ratios of unlike things; here each descriptor is a histogram of two
    bins, so that the coefficient is the mean of the descriptors' own and 1 only where all agree.

    References
    ----------
    P2, section III-D.
    """

    bins = 2 * len(DESCRIPTORS)

    def histograms(self, frame: Frame, positions: Positions, window: Window) -> Histograms:
        """Describe windows; see `WindowFeature.histograms`."""
        matrices = Cooccurrence().histograms(frame, positions, window)
        values = descriptors(matrices)
        pairs = np.stack([values, 1.0 - values], axis=2).reshape(len(values), self.bins)
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
    logarithms = np.log(np.where(matrices > 0, matrices, 1.0))
    values = [
        matrices.max(axis=1),
        matrices @ np.square(difference) / (LEVELS - 1) ** 2,
        matrices @ (1.0 / (1.0 + difference)),
        np.square(matrices).sum(axis=1),
        -(matrices * logarithms).sum(axis=1) / np.log(LEVELS * LEVELS),
    ]
    return np.asarray(np.clip(np.column_stack(values), 0.0, 1.0))
