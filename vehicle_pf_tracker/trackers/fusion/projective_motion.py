"""Constant velocity on the road as the camera sees it: the size changes as the place does."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array

_RATES = np.linspace(-0.04, 0.04, 33)
_RATE_NEEDS = 8
"""Sightings below which the size is taken to stay."""
_MEMORY = 10.0
"""Frames after which an older sighting counts for 1 / e."""
_PLACE_SIGMA = 0.03
"""Standard deviation of a position, of the size."""
_SIZE_SIGMA = 0.04
"""Standard deviation of the logarithm of a size."""
_RATE_SIGMA = 0.02
"""Rates of change of the size are small; per frame."""
_LEAST_DIVISOR = 0.25
_LARGEST_CHANGE = 0.7
"""What the rate may have changed the size by while it was seen."""


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
    times: Array,
    places: Array,
    scales: Array,
    size: float,
    *,
    projective: bool = True,
    sized_until: float = 0.0,
) -> ProjectiveMotion:
    """Fit to what was seen, by weighted least squares over a grid of rates.

    Parameters
    ----------
    times : (N,) array
        In frames, ascending, the last of them 0.
    places : (N, 2) array
        In px.
    scales : (N,) array
        Relative to the first box.
    size : float
        Of the vehicle at scale 1 in px, which errors of places are measured by.
    projective : bool
        False holds the rate at 0: constant velocity and size in the image.
    sized_until : float
        Time after which sizes are not believed: a half-covered vehicle looks smaller.

    Returns
    -------
    ProjectiveMotion
        Its place is half way between the fitted and the last one.
    """
    rates = _RATES if projective and len(times) >= _RATE_NEEDS else np.zeros(1)
    weights = np.exp(times / _MEMORY)
    total = weights.sum()
    divisors = 1.0 - rates[:, np.newaxis] * times
    shares = times / np.maximum(divisors, _LEAST_DIVISOR)
    centres, middle = shares @ weights / total, weights @ places / total
    off = shares - centres[:, np.newaxis]
    # The small summand keeps simultaneous frames solvable, with a slope of zero.
    spread = off**2 @ weights + 1e-9
    velocities = (off * weights) @ (places - middle) / spread[:, np.newaxis]
    residuals = places - middle - off[..., np.newaxis] * velocities[:, np.newaxis]
    logs = np.log(scales * np.maximum(divisors, _LEAST_DIVISOR))
    believed = np.where(times <= max(sized_until, times[min(3, len(times) - 1)]), weights, 0.0)
    log_scales = logs @ believed / believed.sum()
    sigma = _PLACE_SIGMA * size * float(scales.mean())
    costs = (residuals**2).sum(axis=2) @ weights / sigma**2 + (rates / _RATE_SIGMA) ** 2
    costs += (logs - log_scales[:, np.newaxis]) ** 2 @ believed / _SIZE_SIGMA**2
    possible = rates * times[0] <= _LARGEST_CHANGE
    best = int(np.argmin(np.where(possible, costs, np.inf)))
    fitted = middle - centres[best] * velocities[best]
    x, y = (0.5 * (fitted + places[-1])).tolist()
    vx, vy = velocities[best].tolist()
    return ProjectiveMotion((x, y), (vx, vy), float(np.exp(log_scales[best])), float(rates[best]))
