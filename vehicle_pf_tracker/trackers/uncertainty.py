# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Covariance of the position: from the particle cloud, growing while the vehicle is hidden.

The weights of most of the filters have no scale: a sharper likelihood narrows the cloud without
making the estimate better. What a cloud is worth is therefore calibrated, for each variant by
itself, on synthetic scenes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode


@dataclass(frozen=True, slots=True)
class Spread:
    """Parts of the standard deviation, added as variances.

    Attributes
    ----------
    cloud : float
        Part that grows with the particle cloud, in standard deviations of it.
    size : float
        Constant part, in sides of the vehicle (the root of its box's area).
    doubt : float
        Part where the confidence is 0, in sides; proportional to what the confidence lacks to 1.
    change : float
        In sides of the vehicle where its size in the image has changed e-fold since the track
        began: then it is seen from elsewhere, and the middle of its box is another point of it.
    growth : float
        Growth per second without being visible, in sides of the vehicle.
    drift : float
        Along the velocity, in the way that it makes while the vehicle is not visible.
    """

    cloud: float
    size: float
    doubt: float
    change: float
    growth: float = 0.0
    drift: float = 0.0

    def covariance(
        self, estimate: Estimate, period: float, hidden: float, first_area: float
    ) -> Array:
        """Return the covariance (2, 2) of the position, px².

        Parameters
        ----------
        estimate : Estimate
            Estimate of this frame.
        period : float
            Nominal frame period, s.
        hidden : float
            Time since the vehicle was last visible, s.
        first_area : float
            Area of the box that the track began with, px².
        """
        area = estimate.box.area
        doubt = self.doubt * (1 - estimate.confidence)
        # Half of the log area: the log of a side.
        change = self.change * math.log(area / first_area) / 2
        # Independent errors: variances add. Area is the square of the vehicle's side.
        level = area * (self.size**2 + doubt**2 + change**2 + (self.growth * hidden) ** 2)
        # Along the heading alone: a hidden vehicle brakes, and hardly leaves its lane.
        way = self.drift * hidden / period * np.asarray(estimate.velocity)
        spread: Array = self.cloud**2 * cloud_covariance(estimate)
        return spread + level * np.eye(2) + np.outer(way, way)


@dataclass(frozen=True, slots=True)
class Calibration:
    """Spreads of a variant while it claims TRACKING, and otherwise."""

    visible: Spread
    hidden: Spread


def cloud_covariance(estimate: Estimate) -> Array:
    """Return the weighted covariance (2, 2) of the particles, px²."""
    # About the weighted mean; a cloud that sits on one point has none, and the other terms remain.
    apart = estimate.particles - estimate.weights @ estimate.particles
    covariance: Array = (estimate.weights[:, np.newaxis] * apart).T @ apart
    return covariance


class Uncertainty:
    """Covariance of one track's positions.

    Parameters
    ----------
    calibration : Calibration
        Spreads of the variant.
    """

    def __init__(self, calibration: Calibration) -> None:
        self._calibration = calibration
        self._seen_ns: int | None = None
        self._hidden = 0.0
        self._first_area = 0.0

    def follow(self, estimate: Estimate, stamp_ns: int) -> None:
        """Take the next estimate: note for how long the vehicle has not been visible."""
        if estimate.begins or not self._first_area:
            self._first_area = estimate.box.area
        # Time that goes back is a recording that starts again.
        if estimate.mode is Mode.TRACKING or self._seen_ns is None or stamp_ns < self._seen_ns:
            self._seen_ns = stamp_ns
        self._hidden = (stamp_ns - self._seen_ns) * 1e-9

    def covariance(self, estimate: Estimate, period: float) -> Array:
        """Return the covariance (2, 2) of the estimate that was taken last, px²; see `Spread`."""
        visible = estimate.mode is Mode.TRACKING
        spread = self._calibration.visible if visible else self._calibration.hidden
        return spread.covariance(estimate, period, self._hidden, self._first_area)
