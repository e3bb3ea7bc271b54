"""Likelihood of particles: how alike the image is there, and how well the motion leads there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.trackers.fusion.history import Trend
from vehicle_pf_tracker.trackers.fusion.particles import Particles
from vehicle_pf_tracker.trackers.fusion.view import View

_NEAR_PREDICTION = 0.4
"""Standard deviation of the weak prior around the predicted mean, of the size."""
_ON_TREND = 0.2
_ON_TREND_INNOVATIONS = 3.0
"""Standard deviation of the prior around the trend: of the size, or in usual innovations."""
_TREND_SCALE = 0.05
"""The same of the logarithm of the scale."""


@dataclass(frozen=True, slots=True)
class Prior:
    """What the motion says of the state.

    Attributes
    ----------
    predicted : (float, float)
        Mean place of the particles before they are weighed, px.
    extent : float
        Geometric mean of the sides of the box, px.
    trend : Trend or None
        Motion that the particles are held to while looks are in doubt; None while they are not.
    innovation : float
        Usual distance of estimates from the trend, of the size.
    """

    predicted: Position
    extent: float
    trend: Trend | None
    innovation: float

    def log(self, particles: Particles) -> Array:
        """Logarithm of the prior of each particle but for a constant, (N,)."""
        away = ((particles.positions - self.predicted) ** 2).sum(axis=1)
        logs = -0.5 * away / (_NEAR_PREDICTION * self.extent) ** 2
        if self.trend is not None:
            place, scale = self.trend.now()
            within = max(_ON_TREND, _ON_TREND_INNOVATIONS * self.innovation) * self.extent
            off = ((particles.positions - place) ** 2).sum(axis=1) / within**2
            off += (np.log(particles.scales / scale) / _TREND_SCALE) ** 2
            logs -= 0.5 * off
        return np.asarray(logs)


def log_likelihood(view: View, particles: Particles, sharpness: float, prior: Prior) -> Array:
    """Logarithm of the likelihood of each particle, times its prior, but for a constant, (N,)."""
    fused = view.read(view.fused, particles.positions, particles.scales)
    return np.asarray(sharpness * fused + prior.log(particles))
