"""Annealing rates from particle survival rates (Deutscher et al. 2000, section 3).

A layer of an annealed filter weights with ``w ** beta``. Its rate `beta` is chosen so that a wanted
share of the particles survives the resampling that follows.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.filtering.weights import Weights

_PRECISION = 1e-4
_MOST_HALVINGS = 60


def survival_rate(log_weights: Weights, beta: float) -> float:
    """Tell which share of the particles survives resampling with ``w ** beta``, as expected.

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
    weights = np.exp(beta * (log_weights - log_weights.max()))
    return float(weights.sum() ** 2 / (weights @ weights) / len(weights))


def annealing_rate(log_weights: Weights, survival: float, largest: float) -> float:
    """Solve ``survival_rate(log_weights, beta) = survival`` for `beta` by bisection.

    Parameters
    ----------
    log_weights : (N,) array
        Logarithms of the weights in any offset, all finite.
    survival : float
        Wanted survival rate alpha, 0 to 1.
    largest : float
        Upper bound of the rate, taken where more than the wanted share survives even there: equal
        weights survive at every rate.

    Returns
    -------
    float
        From 0 to `largest`, to four digits. The survival rate falls as the rate grows, so there is
        one solution.
    """
    low, high = 0.0, largest
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
