# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Precision and success over their thresholds, as the benchmarks OTB, TrackingNet and LaSOT do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.scores import FrameScore

PRECISION_THRESHOLDS: Array = np.arange(51, dtype=np.float64)
"""Errors of the centre in px: 0, 1, ... 50."""
SUCCESS_THRESHOLDS: Array = np.linspace(0.0, 1.0, 21)
"""Intersections over union: 0, 0.05, ... 1."""
NORMALISED_THRESHOLDS: Array = np.linspace(0.0, 0.5, 51)
"""Errors of the centre in sizes of the true box: 0, 0.01, ... 0.5."""


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


def precision_curve(frames: Sequence[FrameScore]) -> Curve | None:
    """Share of frames with an error of at most each threshold; None without frames.

    Source: Wu, Lim, Yang 2013, section 4 (OTB).
    """
    errors = [frame.error for frame in frames]
    return _at_most(errors, PRECISION_THRESHOLDS)


def normalised_precision_curve(frames: Sequence[FrameScore]) -> Curve | None:
    """Share of frames with a normalised error of at most each threshold; None without frames.

    Source: Mueller et al. 2018, section 4 (TrackingNet); Fan et al. 2019 (LaSOT).
    """
    errors = [frame.normalised_error for frame in frames]
    return _at_most(errors, NORMALISED_THRESHOLDS)


def success_curve(frames: Sequence[FrameScore]) -> Curve | None:
    """Share of frames with an overlap above each threshold; None without frames.

    As in OTB's own code an overlap equal to the threshold does not pass, so that the area of a
    perfect track is 20/21.
    """
    if not frames:
        return None
    overlaps = np.array([frame.overlap or 0.0 for frame in frames])
    shares = (overlaps[:, None] > SUCCESS_THRESHOLDS).mean(axis=0)
    return Curve(SUCCESS_THRESHOLDS, shares)


def _at_most(errors: Sequence[float | None], thresholds: Array) -> Curve | None:
    if not errors:
        return None
    known = np.array([np.inf if error is None else error for error in errors])
    return Curve(thresholds, (known[:, None] <= thresholds).mean(axis=0))
