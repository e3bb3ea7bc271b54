# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Speeds that new vehicles may have: those that the road's vehicles had so far.

Before any is known, a vehicle may be as fast in any direction. Between two images of a sparse
stream that is a reach of several widths, in which a box of another vehicle is as likely as its own;
but along most roads vehicles drive in two directions only, and slower.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.vehicle_state import ANY_SPEED

_ASSUMED_FOR = 0.25
"""Vehicles that the assumed speed is worth. A choice: its variance is some ten times that of the
speeds on most roads, so that more would outweigh a dozen vehicles."""
_UNAMBIGUOUS = 1.0
"""Reach between two images, widths, within which a new vehicle is looked for at any speed: there is
no room for another vehicle. One that turns off is found there, too, and so is the first one that
drives faster than those before."""
_REMEMBERED = 50.0
"""Vehicles above which those that have left are halved: minutes, as a jam begins and ends."""


class Speeds:
    """Second moments of the speeds of vehicles that have left, across and along the road."""

    def __init__(self) -> None:
        self._sums = np.zeros((2, 2))
        self._count = 0.0

    def learn(self, speeds: Array) -> None:
        """Add the speeds (N, 2) of vehicles that have left, widths per second."""
        self._sums += speeds.T @ speeds
        self._count += len(speeds)
        if self._count > _REMEMBERED:
            self._sums /= 2
            self._count /= 2

    def spread(self, speeds: Array, assumed: float, period: float) -> Array:
        """Covariance (2, 2) of a new vehicle's speed across and along, in squares of `assumed`.

        Parameters
        ----------
        speeds : (N, 2) array
            Speeds of the vehicles that are followed, each of which counts once.
        assumed : float
            Standard deviation of the speed that is assumed in either direction.
        period : float
            Nominal interval of images, s. Both speeds are in widths per interval.
        """
        if assumed <= _UNAMBIGUOUS:
            return ANY_SPEED
        # Around zero, not around the mean: vehicles of both directions make a mean of none.
        known = self._sums * period**2 + speeds.T @ speeds
        count = self._count + len(speeds)
        learnt = (known / assumed**2 + _ASSUMED_FOR * ANY_SPEED) / (count + _ASSUMED_FOR)
        return np.asarray(learnt + (_UNAMBIGUOUS / assumed) ** 2 * ANY_SPEED)
