# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Precision and success over thresholds, as OTB, TrackingNet and LaSOT draw them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.scores import FrameScore

PRECISION_THRESHOLDS: Array = np.arange(51, dtype=np.float64)
"""Errors of the centre in px: 0, 1, ... 50, as OTB draws them."""
SUCCESS_THRESHOLDS: Array = np.linspace(0.0, 1.0, 21)
"""Intersections over union: 0, 0.05, ... 1, as OTB draws them."""
NORMALISED_THRESHOLDS: Array = np.linspace(0.0, 0.5, 51)
"""Errors of the centre in sizes of the true box: 0, 0.01, ... 0.5, as TrackingNet and LaSOT do."""


@dataclass(frozen=True, slots=True)
class Curve:
    """Share of frames that pass, by threshold.

    Attributes
    ----------
    thresholds, shares : (K,) array
        The shares are from 0 to 1.
    """

    thresholds: Array
    shares: Array

    @property
    def auc(self) -> float:
        """Mean share over the thresholds, which is what the benchmarks call the area."""
        return float(self.shares.mean())

    def at(self, threshold: float) -> float:
        """Return the share at the threshold of the curve that is nearest to `threshold`."""
        return float(self.shares[np.argmin(np.abs(self.thresholds - threshold))])


def curves(frames: Sequence[FrameScore]) -> dict[str, Curve]:
    """Return the curves of scored frames by name; none without frames.

    ``precision``: share of frames with an error of at most each threshold (Wu, Lim, Yang 2013,
    section 4: OTB). ``normalised``: with a normalised error of at most each (Mueller et al. 2018,
    section 4: TrackingNet; Fan et al. 2019: LaSOT). ``success``: with an overlap above each; as in
    OTB's own code one equal to the threshold does not pass, so that a perfect track has 20/21.
    """
    # Without truth there is no curve, rather than one of zeros.
    if not frames:
        return {}
    errors = np.array([[f.error, f.normalised_error] for f in frames], dtype=np.float64)
    errors[np.isnan(errors)] = np.inf  # of None
    # Where there is no box to compare, nothing overlaps.
    overlaps = np.array([frame.overlap or 0.0 for frame in frames])
    # Frames against thresholds, (F, K): the mean over the frames is the curve.
    passed = {
        "precision": (PRECISION_THRESHOLDS, errors[:, :1] <= PRECISION_THRESHOLDS),
        "success": (SUCCESS_THRESHOLDS, overlaps[:, np.newaxis] > SUCCESS_THRESHOLDS),
        "normalised": (NORMALISED_THRESHOLDS, errors[:, 1:] <= NORMALISED_THRESHOLDS),
    }
    return {
        name: Curve(thresholds, passes.mean(axis=0))
        for name, (thresholds, passes) in passed.items()
    }
