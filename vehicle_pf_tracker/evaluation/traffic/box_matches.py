# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pairs of boxes that belong to each other, one to one."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import overlaps as overlaps_of_edges

_LEAST_OVERLAP = 0.5
"""Least overlap (intersection over union) of boxes that belong to each other: MOTChallenge's."""


def matches(first: Array, second: Array) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Match boxes one to one so that the sum of overlaps of at least `_LEAST_OVERLAP` is largest.

    Returns
    -------
    array of int, array of int
        Indices into `first` and `second`.
    """
    overlap = overlaps(first, second)
    # Below the limit worth nothing: else a pair too far apart could break two good ones.
    overlap[overlap < _LEAST_OVERLAP] = 0
    rows, columns = linear_sum_assignment(-overlap)
    good = overlap[rows, columns] > 0
    return rows[good], columns[good]


def overlaps(first: Array, second: Array) -> Array:
    """Intersection over union of each pair of boxes (left, top, width, height)."""
    return overlaps_of_edges(edges_of(first)[:, None], edges_of(second))


def edges_of(boxes: Array) -> Array:
    """Left, top, right and bottom of boxes (left, top, width, height), (N, 4), px."""
    return np.hstack([boxes[:, :2], boxes[:, :2] + boxes[:, 2:]])
