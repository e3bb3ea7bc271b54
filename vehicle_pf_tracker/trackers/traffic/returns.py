# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shares learnt from what a detector misses: how much returns, by place, and how much it finds."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.detection_evidence import PLACE_COUNT
from vehicle_pf_tracker.trackers.traffic.rows import Bools

_UNKNOWN = 0.5
"""Share that is seen again, before any outcome is known: either is as likely."""
_UNIFORM = 2.0
"""Outcomes that a prior is worth: as many as a uniform one, Beta(1, 1)."""
_REMEMBERED = 30
"""Outcomes of a place above which they are halved: leaves and road works come and go. A choice: of
30 a share has a standard deviation of .09 at most."""
_FIRST_ASKED = 10.0
"""Vehicles in plain sight that were detected, and that were missed, before any was seen. A choice:
a rate of a half, which a second of one vehicle outweighs."""
_ASKED = 2000.0
"""Vehicles asked for above which they are halved: minutes of a few vehicles, in which weather and
light change what a detector finds, as for its scores."""


class Returns:
    """How much of what vanished in plain sight was seen again, by place.

    Below a bridge nearly all is, elsewhere hardly anything: what vanished was no vehicle, or no
    part of one, or its detections went to another. The share in one place is a beta-binomial
    estimate, whose prior is the share everywhere; that begins at a half.
    """

    def __init__(self) -> None:
        self._counts = np.zeros((2, PLACE_COUNT))

    def learn(self, place: int, *, found: bool) -> None:
        """Add an outcome."""
        self._counts[int(found), place] += 1
        if self._counts[:, place].sum() > _REMEMBERED:
            self._counts[:, place] /= 2

    def share(self, place: int) -> float:
        """Share that is seen again."""
        # Two levels: a place that nothing is known of takes what is usual at this camera.
        everywhere = _estimated(self._counts.sum(axis=1), _UNKNOWN)
        return _estimated(self._counts[:, place], everywhere)


def _estimated(outcomes: Array, prior: float) -> float:
    """Posterior mean of a share, of the numbers without and with it."""
    without, found = outcomes.tolist()
    return float((found + _UNIFORM * prior) / (without + found + _UNIFORM))


class DetectionRate:
    """Share of the vehicles in plain sight that the detector finds."""

    def __init__(self) -> None:
        # Without the prior, which stays what it is.
        self._detected = 0.0
        self._asked = 0.0

    def learn(self, asked: Bools, detected: Bools) -> Array:
        """Add the vehicles (N,) that it was asked for, one by one; the share (N,) after each."""
        # Misses are in the count from the start, so that the share never is 1: a miss would cost
        # infinitely much.
        found = self._detected + np.cumsum(asked & detected)
        total = self._asked + np.cumsum(asked)
        if len(asked):
            # Halved after the frame: the order of its vehicles is not to matter more than it does.
            share = 0.5 if total[-1] > _ASKED else 1.0
            self._detected = share * float(found[-1])
            self._asked = share * float(total[-1])
        return np.asarray((found + _FIRST_ASKED) / (total + 2 * _FIRST_ASKED))

    @property
    def share(self) -> float:
        """The share."""
        return (self._detected + _FIRST_ASKED) / (self._asked + 2 * _FIRST_ASKED)
