# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Speed on the road: a Kalman filter of constant velocity over measured positions."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array

KMH_PER_MS = 3.6
"""km/h in a m/s."""
_SPEED_SIGMA = 40.0
"""Standard deviation of each part of the velocity before anything is known, m/s: 140 km/h."""


@dataclass(frozen=True, slots=True, eq=False)
class RoadMotion:
    """Position and velocity on the road, with their covariance.

    Attributes
    ----------
    state : (4,) array
        x, y in m, and their rates in m/s.
    covariance : (4, 4) array
        Covariance of `state`.
    """

    state: Array
    covariance: Array

    @classmethod
    def at(cls, position: Array, covariance: Array) -> RoadMotion:
        """Begin at a measured position (2,), m, with its covariance (2, 2); speed unknown."""
        full = np.zeros((4, 4))
        full[:2, :2] = covariance
        # Wide, not infinite: the second position decides, and the matrices stay invertible.
        full[2:, 2:] = np.eye(2) * _SPEED_SIGMA**2
        return cls(np.concatenate([position, np.zeros(2)]), full)

    def predicted(self, seconds: float, acceleration: float) -> RoadMotion:
        """Move on by `seconds`.

        Parameters
        ----------
        seconds : float
            Time, s.
        acceleration : float
            Standard deviation of the change of velocity within a second, m/s: the velocity does a
            random walk.
        """
        step = np.eye(4)
        step[0, 2] = step[1, 3] = seconds
        square = seconds**2 / 2
        cube = seconds**3 / 3
        # White acceleration integrated over the time (Bar-Shalom): right for any frame rate.
        walk = np.kron([[cube, square], [square, seconds]], np.eye(2)) * acceleration**2
        return RoadMotion(step @ self.state, step @ self.covariance @ step.T + walk)

    def measured(self, position: Array, covariance: Array) -> RoadMotion:
        """Take a measured position (2,), m, with its covariance (2, 2)."""
        gain = np.linalg.solve(self.covariance[:2, :2] + covariance, self.covariance[:2]).T
        state = self.state + gain @ (position - self.state[:2])
        # Joseph's form stays symmetric and positive whatever the gain's rounding.
        kept = np.eye(4)
        kept[:, :2] -= gain
        after = kept @ self.covariance @ kept.T + gain @ covariance @ gain.T
        return replace(self, state=state, covariance=after)

    @property
    def velocity(self) -> Array:
        """Velocity (2,), m/s."""
        return self.state[2:]

    @property
    def speed(self) -> float:
        """Speed, m/s."""
        return float(np.linalg.norm(self.velocity))

    @property
    def speed_deviation(self) -> float:
        """Standard deviation of the speed, m/s: of the velocity along its direction."""
        covariance = self.covariance[2:, 2:]
        speed = self.speed
        if speed == 0:
            return float(np.sqrt(np.linalg.norm(covariance, 2)))
        # To the first order; at a standstill above the speed has no direction to be known along.
        along = self.velocity / speed
        return float(np.sqrt(along @ covariance @ along))
