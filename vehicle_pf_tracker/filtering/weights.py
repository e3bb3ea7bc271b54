# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Importance weights of a particle cloud."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Weights = npt.NDArray[np.float64]


def normalise(weights: Weights) -> tuple[Weights, bool]:
    """Scale weights so that they sum to one (P1 eq. 6).

    Parameters
    ----------
    weights : (N,) array
        Non-negative weights in any scale.

    Returns
    -------
    normalised : (N,) array
        Sums to one.
    sound : bool
        False where the weights carry no information (all zero, negative, or not finite); they are
        uniform then, and the caller has to report a confidence of zero.
    """
    weights = np.asarray(weights, dtype=np.float64)
    largest = weights.max()
    if not (math.isfinite(largest) and largest > 0 and weights.min() >= 0):
        return _uniform(len(weights)), False
    # Dividing by the largest first keeps tiny weights exact and huge ones from summing to infinity.
    scaled = weights / largest
    scaled /= scaled.sum()
    return scaled, True


def from_log(log_weights: Weights) -> tuple[Weights, bool]:
    """Normalise weights given as logarithms, without underflow.

    Parameters
    ----------
    log_weights : (N,) array
        Logarithms in any offset; minus infinity is a weight of zero.

    Returns
    -------
    normalised, sound
        As for `normalise`.
    """
    largest = log_weights.max()
    # All minus infinity, or one plus infinity or not a number: no ratio of two is known.
    if not math.isfinite(largest):
        return _uniform(len(log_weights)), False
    weights = np.exp(log_weights - largest)  # the largest is one
    weights /= weights.sum()
    return weights, True


def effective_sample_size(weights: Weights) -> float:
    """Count the equally weighted particles that would do as well, ``1 / sum(w²)``.

    Parameters
    ----------
    weights : (N,) array
        Normalised weights.

    Returns
    -------
    float
        From 1 (one particle carries everything) to N (uniform).

    References
    ----------
    P2 eq. 14 and P3, with normalised weights (interpretation 16).
    """
    return float(1.0 / np.square(weights).sum())


def _uniform(count: int) -> Weights:
    return np.full(count, 1.0 / count)
