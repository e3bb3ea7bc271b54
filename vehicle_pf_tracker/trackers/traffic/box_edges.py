# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of boxes as measurements: how exact they are, and which the image's border cuts."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.rows import Bools
from vehicle_pf_tracker.trackers.traffic.vehicle_state import PIXEL_NOISE

ScalarT = TypeVar("ScalarT", bound=np.generic)

INWARD_SIGNS = np.array([1.0, 1.0, -1.0, -1.0])
"""Sign of a residual (detection less prediction) of left, top, right, bottom that points inward."""


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
    return both_ends(_deviations_by_axis(edges, noise))


def _deviations_by_axis(edges: Array, noise: float) -> Array:
    """Estimate those (..., 2) across and down: opposite edges are equally exact."""
    # Independent errors: one grows with the vehicle, the grid of pixels does not.
    return np.asarray(np.hypot(sides_of(edges) * noise, PIXEL_NOISE))


def both_ends(values: npt.NDArray[ScalarT]) -> npt.NDArray[ScalarT]:
    """Give values (..., 2) across and down to both edges of each axis: (..., 4)."""
    return np.concatenate([values, values], axis=-1)


def opposites(values: Array) -> Array:
    """Values (N, 4) of left, top, right and bottom in the order of the opposite edges."""
    return np.concatenate([values[:, 2:], values[:, :2]], axis=1)


def cut_edges(edges: Array, size: tuple[int, int], noise: float) -> Bools:
    """Find the edges of boxes (..., 4) that lie beyond the borders of an image, or may do.

    They may where they are nearer than their own deviation; `noise` is that of `deviations`.
    """
    margin = _deviations_by_axis(edges, noise)
    return np.concatenate([edges[..., :2] <= margin, edges[..., 2:] >= size - margin], axis=-1)
