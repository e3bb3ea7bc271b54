"""Constant velocity on the road as the camera sees it: the size changes as the place does."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.trackers.estimate import Array

_RATES = np.linspace(-0.04, 0.04, 81)
_PLACE_SIGMA = 0.04
"""Standard deviation of a position, of the size."""
_SIZE_SIGMA = 0.06
"""Standard deviation of the logarithm of a size."""
_RATE_SIGMA = 0.01
"""Rates of change of the size are small; per frame."""
_LEAST_DIVISOR = 0.25


@dataclass(frozen=True, slots=True)
class ProjectiveMotion:
    """``p(t) = p0 + V t / (1 - r t)`` and ``s(t) = s0 / (1 - r t)``.

    Attributes
    ----------
    place, velocity : (float, float)
        p0 in px and V in px per frame, at time 0.
    scale : float
        s0, relative to the first box.
    rate : float
        r per frame: above 0 the vehicle comes closer.
    """

    place: tuple[float, float]
    velocity: tuple[float, float]
    scale: float
    rate: float

    def at(self, time: float) -> tuple[tuple[float, float], float]:
        """Place in px and scale, `time` frames after time 0."""
        # A vehicle that comes closer passes the camera; it does not grow without bound.
        divisor = max(1.0 - self.rate * time, _LEAST_DIVISOR)
        share = time / divisor
        x, y = self.place
        place = x + self.velocity[0] * share, y + self.velocity[1] * share
        return place, self.scale / divisor

    def velocity_at(self, time: float) -> tuple[float, float]:
        """Give the derivative of the place, px per frame."""
        divisor = max(1.0 - self.rate * time, _LEAST_DIVISOR)
        return self.velocity[0] / divisor**2, self.velocity[1] / divisor**2

    def moved(self, shift: tuple[float, float], zoom: float) -> ProjectiveMotion:
        """Return the motion seen by a camera that has moved: ``zoom * p + shift``."""
        place = zoom * self.place[0] + shift[0], zoom * self.place[1] + shift[1]
        velocity = zoom * self.velocity[0], zoom * self.velocity[1]
        return replace(self, place=place, velocity=velocity, scale=zoom * self.scale)


def fit_motion(
    times: Array, places: Array, scales: Array, size: float, *, projective: bool = True
) -> ProjectiveMotion:
    """Fit to what was seen, by least squares over a grid of rates.

    Parameters
    ----------
    times : (N,) array
        In frames, at most 0.
    places : (N, 2) array
        In px.
    scales : (N,) array
        Relative to the first box.
    size : float
        Of the vehicle at scale 1 in px, which errors of places are measured by.
    projective : bool
        False holds the rate at 0: constant velocity and size in the image.
    """
    rates = _RATES if projective else np.zeros(1)
    sigma = _PLACE_SIGMA * size * float(scales.mean()) + 0.3
    exact = 1.0 - rates[:, np.newaxis] * times
    divisors = np.maximum(exact, _LEAST_DIVISOR)
    shares = times / divisors
    origins, velocities = _lines(shares, places)
    logs = np.log(scales * divisors)
    log_scales = logs.mean(axis=1)
    off_places = (
        places - origins[:, np.newaxis] - shares[..., np.newaxis] * velocities[:, np.newaxis]
    )
    costs = (off_places**2).sum(axis=(1, 2)) / sigma**2 + (rates / _RATE_SIGMA) ** 2
    costs += ((logs - log_scales[:, np.newaxis]) ** 2).sum(axis=1) / _SIZE_SIGMA**2
    possible = exact.min(axis=1) >= _LEAST_DIVISOR
    best = int(np.argmin(np.where(possible, costs, np.inf)))
    (x, y), (vx, vy) = origins[best].tolist(), velocities[best].tolist()
    return ProjectiveMotion((x, y), (vx, vy), float(np.exp(log_scales[best])), float(rates[best]))


def _lines(shares: Array, places: Array) -> tuple[Array, Array]:
    """Regress places (N, 2) on each row of `shares` (R, N): places at zero and slopes, (R, 2)."""
    middles, centre = shares.mean(axis=1, keepdims=True), places.mean(axis=0)
    off = shares - middles
    # The small summand keeps simultaneous frames solvable, with a slope of zero.
    slopes = off @ (places - centre) / ((off**2).sum(axis=1, keepdims=True) + 1e-6)
    return centre - middles * slopes, slopes
