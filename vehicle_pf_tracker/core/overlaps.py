# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Areas and overlaps of many boxes at once, given by their edges: left, top, right, bottom."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections

NO_BOXES = np.empty((0, 4))
"""Edges (0, 4) of no boxes."""


def areas(edges: Array) -> Array:
    """Measure the areas of boxes (..., 4) in px², at least 1, so that shares of them are finite."""
    sides = np.maximum(edges[..., 2:] - edges[..., :2], 0.0)
    return np.asarray(np.maximum(sides[..., 0] * sides[..., 1], 1.0))


def overlaps(edges: Array, others: Array) -> Array:
    """Measure the intersection over union of boxes (..., 4) with others (..., 4)."""
    common = intersections(edges, others)
    return np.asarray(common / (areas(edges) + areas(others) - common))


def are_alone(edges: Array) -> npt.NDArray[np.bool_]:
    """Find the boxes (N, 4) that overlap none of the others."""
    # One overlap is with itself.
    return np.asarray((intersections(edges[:, np.newaxis], edges) > 0).sum(axis=1) == 1)


def inside_image(edges: Array, size: tuple[int, int]) -> Array:
    """Measure the shares of boxes (..., 4) that lie in an image of this width and height, px."""
    return np.asarray(intersections(edges, np.array([0.0, 0.0, *size])) / areas(edges))


def clipped(edges: Array, size: tuple[int, int]) -> Array:
    """Cut boxes (N, 4) at the borders of the image, but keep one px of width and height."""
    ends = np.array(size, dtype=np.float64)
    low = np.minimum(np.maximum(edges[:, :2], 0.0), ends - 1)
    high = np.minimum(np.maximum(edges[:, 2:], 0.0), ends)
    return np.concatenate([low, np.maximum(high, low + 1)], axis=1)
