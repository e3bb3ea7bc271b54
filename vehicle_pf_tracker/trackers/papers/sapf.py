# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`sapf`: the annealed particle filter of Deutscher et al. 2000 (P1's [10]).

Each frame is searched in layers. The first spreads its particles wide and weights them softly, so
that no early maximum takes all; every next layer resamples, spreads less, and weights with
``w ** beta``, where `beta` is chosen so that a given share of particles survives the resampling
that follows (section 3). It has no occlusion branch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.weights import Weights, from_log
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import ColourParameters, ColourTracker
from vehicle_pf_tracker.trackers.papers.shared import log_likelihood
from vehicle_pf_tracker.trackers.parameters import particles_parameter

_PRECISION = 1e-4
"""Relative precision of an annealing rate, far below the effect of a different random draw."""
_MOST_HALVINGS = 60
"""Bound of the bisection: after 53 halvings an interval of float64 cannot shrink any further."""


def survival_rate(log_weights: Weights, beta: float) -> float:
    """Compute the expected share of the particles that survive resampling with ``w ** beta``.

    Parameters
    ----------
    log_weights : (N,) array
        Logarithms of the weights in any offset, all finite.
    beta : float
        Annealing rate, at least 0.

    Returns
    -------
    float
        ``D(beta) / N`` with the survival diagnostic ``D = 1 / sum(w²)`` of the normalised
        ``w ** beta``: from the share of particles that have the largest weight, to 1.
    """
    # Relative to the largest, which is one then: no rate makes them overflow.
    weights = np.exp(beta * (log_weights - log_weights.max()))
    return float(weights.sum() ** 2 / (weights @ weights) / len(weights))


def annealing_rate(log_weights: Weights, survival: float, largest: float) -> float:
    """Solve ``survival_rate(log_weights, beta) = survival`` for `beta` by bisection.

    Parameters
    ----------
    log_weights : (N,) array
        Logarithms of the weights in any offset, all finite.
    survival : float
        Target survival rate alpha, 0 to 1.
    largest : float
        Upper bound of the rate, returned where more than the target share survives even there:
        equal weights survive at every rate.

    Returns
    -------
    float
        From 0 to `largest`, to four digits. The survival rate falls as the rate grows, so there is
        one solution.
    """
    low = 0.0
    high = largest
    # Never sharper than `largest`: a likelihood that is flat everywhere is no evidence, and the
    # sharpest rate would make peaks of its noise.
    if survival_rate(log_weights, high) >= survival:
        return high
    for _ in range(_MOST_HALVINGS):
        middle = (low + high) / 2
        if survival_rate(log_weights, middle) >= survival:
            low = middle
        else:
            high = middle
        if high - low <= _PRECISION * high:
            break
    return high


@dataclass(frozen=True, slots=True)
class AnnealingParameters:
    """The layers of one frame's search."""

    layers: int = parameter(
        4, "More: the search narrows in smaller steps, at the time of num_particles each.",
        bounds=(1, 50), source="Deutscher 2000 section 3", tuned=True,
    )  # fmt: skip
    survival: float = parameter(
        0.5, "Lower: each layer keeps fewer particles, and settles on a maximum sooner.",
        bounds=(0.01, 1.0), unit="share of the particles",
        source="Deutscher 2000 section 3 (alpha)",
    )  # fmt: skip
    decay: float = parameter(
        0.6, "Lower: later layers spread their particles less.", bounds=(0.01, 1.0),
        unit="of the layer before", source="in place of Deutscher's tie, see tied", tuned=True,
    )  # fmt: skip
    tied: bool = parameter(
        False, "On: each layer's covariance shrinks by the share of particles that survived, as "
        "Deutscher ties them; off: its spread shrinks by decay.",
        source="Deutscher 2000 section 3 (covariance scaled by the survival rates)",
    )  # fmt: skip
    largest_rate: float = parameter(
        1.0, "Higher: layers may weight more sharply than the likelihood, to let fewer survive.",
        bounds=(0.01, 1e6), source="Deutscher 2000 section 3 (beta)",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class SapfParameters(ColourParameters):
    """Parameters of `sapf`."""

    num_particles: int = particles_parameter(
        50, "Particles of each layer; more: steadier estimates, at more time per frame."
    )
    annealing: AnnealingParameters = group(AnnealingParameters)


class SapfTracker(ColourTracker[SapfParameters]):
    """The annealed particle filter; the resampling after the last layer opens the next frame."""

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame in layers: each resamples, spreads less than the last one, and weighs."""
        settings = self._settings
        annealing = settings.annealing
        cloud = self._cloud
        sigma = settings.sigma * elapsed
        left_image = False
        # From the widest spread to the narrowest: Deutscher's layers M to 1.
        for _ in range(annealing.layers):
            particles, left_image = self._diffuse(frame, self._resample(cloud), sigma)
            rho = self.similarity(frame, particles)
            log_weights = log_likelihood(rho, settings.likelihood)
            # Flat weights first, so that the layer keeps all maxima; later ones choose among them.
            beta = annealing_rate(log_weights, annealing.survival, annealing.largest_rate)
            cloud = Cloud(particles, *from_log(beta * log_weights))
            # Where many survived the layer has not settled, and the next must still search wide.
            if annealing.tied:
                # Deutscher scales the covariance; sigma is its root.
                sigma *= survival_rate(log_weights, beta) ** 0.5
            else:
                sigma *= annealing.decay
        return self._report(frame, cloud, elapsed, left_image=left_image, passes=annealing.layers)
