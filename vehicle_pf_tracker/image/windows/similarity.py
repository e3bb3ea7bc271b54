# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Similarity of histograms: Bhattacharyya coefficient and Hellinger distance to a reference."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

Histogram: TypeAlias = npt.NDArray[np.float64]
"""Shares of bins, (bins,), whose sum is one."""


def bhattacharyya_coefficient(p: Array, q: Array) -> Array:
    """Sum of ``sqrt(p q)`` over the bins (P1 eq. 24), from 0 (disjoint) to 1 (equal).

    Parameters
    ----------
    p, q : (..., bins) arrays
        Normalised histograms; leading dimensions broadcast.
    """
    # Rounding may take the sum of equal histograms above 1, and its distance below 0.
    return np.asarray(np.minimum(np.sqrt(p * q).sum(axis=-1), 1.0))


def hellinger_distance(coefficient: Array) -> Array:
    """``sqrt(1 - rho)`` of a Bhattacharyya coefficient (P1 eq. 23), from 0 (equal) to 1."""
    # Rounding may take a coefficient of the kernels above 1.
    return np.sqrt(np.maximum(1.0 - np.asarray(coefficient), 0.0))


def hellinger_similarity(p: Array, q: Array) -> float:
    """``1 - d_B`` of two normalised histograms (bins,), from 0 (disjoint) to 1 (equal)."""
    # Scalars without arrays: one pair of histograms in each frame.
    coefficient = min(float(np.sqrt(p * q).sum()), 1.0)
    return 1.0 - math.sqrt(max(1.0 - coefficient, 0.0))


class Reference:
    """Normalised histogram that windows are compared with, and its active bins.

    Only bins that occur in the reference can add to a Bhattacharyya coefficient, so that only those
    are counted in windows. What follows from them is kept, since a reference may serve many frames.

    Parameters
    ----------
    histogram : (bins,) array
        Sums to one, or is all zero and similar to nothing; not changed afterwards.
    """

    def __init__(self, histogram: Histogram) -> None:
        self.histogram = np.asarray(histogram, dtype=np.float64)

    @cached_property
    def active(self) -> npt.NDArray[np.intp]:
        """Numbers of the bins that are not zero, ascending, shape (K,)."""
        return np.flatnonzero(self.histogram)

    @cached_property
    def values(self) -> Histogram:
        """The histogram at the active bins, shape (K,)."""
        # Cached: a reference serves many frames, and never changes.
        return self.histogram[self.active]
