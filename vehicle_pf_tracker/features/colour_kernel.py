"""Similarity of many windows' joint colour histograms at once.

Only bins that occur in the reference can add to a Bhattacharyya coefficient, so that only those
are counted (`window_sums`).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.features.colour import Histogram, bin_count, bin_indices
from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.window import Positions, Window, bounds
from vehicle_pf_tracker.features.window_sums import areas, bin_counts, covered_region

Coefficients = npt.NDArray[np.float64]


def joint_similarity(
    frame: Frame, positions: Positions, window: Window, reference: Histogram, bits: int
) -> Coefficients:
    """Bhattacharyya coefficient of each window's joint histogram with `reference` (P1 eq. 24).

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    positions : (N, 2) array
        Window centres in px.
    window : Window
        Size of all windows; over the border the pixels that exist count.
    reference : (bin_count(bits),) array
        Normalised histogram; all zero is similar to nothing.
    bits : int
        Bits a channel.

    Returns
    -------
    (N,) array
        From 0 to 1.
    """
    active = np.flatnonzero(reference)
    if len(active) == 0:
        return np.zeros(len(positions))
    region, windows = covered_region(frame, bounds(frame, positions, window))
    counts = bin_counts(bin_indices(region, bits), active, bin_count(bits), windows)
    overlap = np.sqrt(counts * reference[active]).sum(axis=1)
    return np.asarray(np.minimum(overlap / np.sqrt(areas(windows)), 1.0))
