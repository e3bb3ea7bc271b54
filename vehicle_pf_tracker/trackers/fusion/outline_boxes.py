# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bounding boxes of outlines: low and high corner (2, 2) of each, px."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array

LEAST_AREA = 0.25
"""Least area of an outline that is a vehicle's, fraction of its box: less is a piece, and may be
the tip of a shadow. The quarter is a choice; end on, a car has half of the area of its side."""
MOST_AREA = 2.0
"""Largest such area: beyond, another vehicle has merged with it, or it is a larger one. A choice: a
shadow may be as large as the vehicle, and from aside a car has twice the area of its end."""


def areas(boxes: Array) -> Array:
    """Areas (N,) of boxes (N, 2, 2), px squared."""
    return np.asarray((boxes[:, 1] - boxes[:, 0]).prod(axis=1))


def front_move(first: Array, last: Array) -> Array:
    """Displacement (2,), px, of the sides in front, from the first box (2, 2) to the last.

    Of what comes out from behind something the side in front moves all the time, the other one
    once all has come out: along each axis the larger displacement counts.
    """
    moves = last - first
    return np.asarray(np.where(np.abs(moves[1]) > np.abs(moves[0]), moves[1], moves[0]))
