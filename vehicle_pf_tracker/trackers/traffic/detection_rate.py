# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Share of the vehicles in plain sight that a detector finds, learnt from what it misses."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.rows import Bools

_FIRST_ASKED = 10.0
"""Vehicles in plain sight that were detected, and that were missed, before any was seen. A choice:
a rate of a half, which a second of one vehicle outweighs."""
_ASKED = 2000.0
"""Vehicles asked for above which they are halved: minutes of a few vehicles, in which weather and
light change what a detector finds, as for its scores."""


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
