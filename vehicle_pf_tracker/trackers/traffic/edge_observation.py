# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of a vehicle's box as linear functions of its state, relative to the horizon."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from vehicle_pf_tracker.core.array import Array

X, V, W, H, ACROSS, ALONG = range(6)
"""Components of the state: centre and distance from the horizon, size (px), road velocities."""


class Edge(IntEnum):
    """Edges of a box, in the order of measurements."""

    LEFT = 0
    TOP = 1
    RIGHT = 2
    BOTTOM = 3


OBSERVATION = np.array(
    [
        [1.0, 0.0, -0.5, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, -1.0, 0.0, 0.0],
        [1.0, 0.0, 0.5, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    ]
)
"""Edges of the box as linear functions of the state (relative to the horizon)."""


def edge_of(values: Array, edge: Edge) -> Array:
    """Product of an edge's row of `OBSERVATION` with the last axis of values (..., 6)."""
    if edge is Edge.BOTTOM:
        return values[..., V]
    if edge is Edge.TOP:
        return np.asarray(values[..., V] - values[..., H])
    half = 0.5 * values[..., W]
    return np.asarray(values[..., X] - half if edge is Edge.LEFT else values[..., X] + half)


def edge_rows(covariances: Array) -> Array:
    """Product of `OBSERVATION` with covariances (N, 6, ...): (N, 4, ...)."""
    half = 0.5 * covariances[:, W]
    left = covariances[:, X] - half
    right = covariances[:, X] + half
    return np.stack([left, covariances[:, V] - covariances[:, H], right, covariances[:, V]], axis=1)
