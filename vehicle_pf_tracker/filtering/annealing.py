"""Annealing rates from particle survival rates (Deutscher et al. 2000, section 3).

A layer of an annealed filter weights with ``w ** beta``. Its rate `beta` is chosen so that a wanted
share of the particles survives the resampling that follows.
"""

from __future__ import annotations

from vehicle_pf_tracker.filtering.weights import Weights, effective_sample_size, from_log

_HALVINGS = 40
"""Bisection steps; 40 leave the rate exact to 1e-12 of the interval."""


def survival_rate(log_weights: Weights, beta: float) -> float:
    """Tell which share of the particles survives resampling with ``w ** beta``, as expected.

    Parameters
    ----------
    log_weights : (N,) array
        Logarithms of the weights in any offset.
    beta : float
        Annealing rate, above 0.

    Returns
    -------
    float
        ``D(beta) / N`` with the survival diagnostic ``D = 1 / sum(w²)`` of the normalised
        ``w ** beta``: from the share of particles that have the largest weight, to 1.
    """
    weights, _ = from_log(beta * log_weights)
    return effective_sample_size(weights) / len(weights)


def annealing_rate(log_weights: Weights, survival: float, largest: float) -> float:
    """Solve ``survival_rate(log_weights, beta) = survival`` for `beta` by bisection.

    Parameters
    ----------
    log_weights : (N,) array
        Logarithms of the weights in any offset.
    survival : float
        Wanted survival rate alpha, 0 to 1.
    largest : float
        Upper bound of the rate, taken where more than the wanted share survives even there: equal
        weights survive at every rate.

    Returns
    -------
    float
        From 0 to `largest`. The survival rate falls as the rate grows, so there is one solution.
    """
    low, high = 0.0, largest
    if survival_rate(log_weights, high) >= survival:
        return high
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if survival_rate(log_weights, middle) >= survival:
            low = middle
        else:
            high = middle
    return low
