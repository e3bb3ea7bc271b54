"""How alike two histograms are: Bhattacharyya coefficient and Hellinger distance."""

from __future__ import annotations

import math

import numpy as np

from vehicle_pf_tracker.core.array import Array


def bhattacharyya_coefficient(p: Array, q: Array) -> Array:
    """Sum of ``sqrt(p q)`` over the bins (P1 eq. 24), from 0 (disjoint) to 1 (equal).

    Parameters
    ----------
    p, q : (..., bins) arrays
        Normalised histograms; leading dimensions broadcast.
    """
    return np.asarray(np.minimum(np.sqrt(p * q).sum(axis=-1), 1.0))


def hellinger_distance(coefficient: Array) -> Array:
    """``sqrt(1 - rho)`` of a Bhattacharyya coefficient (P1 eq. 23), from 0 (equal) to 1."""
    return np.sqrt(np.maximum(1.0 - np.asarray(coefficient), 0.0))


def hellinger_similarity(p: Array, q: Array) -> float:
    """``1 - d_B`` of two normalised histograms (bins,), from 0 (disjoint) to 1 (equal)."""
    coefficient = min(float(np.sqrt(p * q).sum()), 1.0)
    return 1.0 - math.sqrt(max(1.0 - coefficient, 0.0))
