# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of boxes as measurements: how exact they are, and which the image's border cuts."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.rows import Bools
from vehicle_pf_tracker.trackers.traffic.vehicle_state import PIXEL_NOISE, Edge

INWARD_SIGNS = np.array([1.0, 1.0, -1.0, -1.0])
"""Sign of a residual (detection less prediction) of left, top, right, bottom that points inward."""
OPPOSITE = [Edge.RIGHT, Edge.BOTTOM, Edge.LEFT, Edge.TOP]
"""The opposite of each edge."""


def sides_of(edges: Array) -> Array:
    """Width and height (..., 2) of boxes (..., 4), px."""
    return np.asarray(edges[..., 2:] - edges[..., :2])


def deviations(edges: Array, noise: float) -> Array:
    """Estimate the standard deviations (..., 4) of measured edges in px.

    Parameters
    ----------
    edges : (..., 4) array
        Boxes in px.
    noise : float
        Standard deviation of an edge, fraction of the box's side.
    """
    size = sides_of(edges)
    # Independent errors: one grows with the vehicle, the grid of pixels does not.
    return np.asarray(np.hypot(np.concatenate([size, size], axis=-1) * noise, PIXEL_NOISE))


def cut_edges(edges: Array, size: tuple[int, int], noise: float) -> Bools:
    """Find the edges of boxes (..., 4) that lie beyond the borders of an image, or may do.

    They may where they are nearer than their own deviation; `noise` is that of `deviations`.
    """
    # One for each axis: left and right, top and bottom are equally exact.
    margin = deviations(edges, noise)[..., :2]
    return np.concatenate([edges[..., :2] <= margin, edges[..., 2:] >= size - margin], axis=-1)
