# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of boxes as measurements: how exact they are, and which the image's border cuts."""

from __future__ import annotations

from dataclasses import dataclass
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


def both_ends(values: npt.NDArray[ScalarT]) -> npt.NDArray[ScalarT]:
    """Give values (..., 2) across and down to both edges of each axis: (..., 4)."""
    return np.concatenate([values, values], axis=-1)


def opposites(values: Array) -> Array:
    """Values (N, 4) of left, top, right and bottom in the order of the opposite edges."""
    return np.concatenate([values[:, 2:], values[:, :2]], axis=1)


@dataclass(frozen=True, slots=True)
class MeasurementModel:
    """How a detector measures the edges of boxes in images of one size.

    Attributes
    ----------
    size : (int, int)
        Width and height of the image, px.
    noise : float
        Standard deviation of an edge, fraction of the box's side.
    """

    size: tuple[int, int]
    noise: float

    def deviations(self, edges: Array) -> Array:
        """Estimate the standard deviations (..., 4) in px of measured edges (..., 4) in px."""
        return both_ends(self._deviations_by_axis(edges))

    def cut_edges(self, edges: Array) -> Bools:
        """Find the edges of boxes (..., 4) that lie beyond the image's borders, or may do.

        They may where they are nearer than their own deviation.
        """
        margin = self._deviations_by_axis(edges)
        is_low = edges[..., :2] <= margin
        return np.concatenate([is_low, edges[..., 2:] >= self.size - margin], axis=-1)

    def _deviations_by_axis(self, edges: Array) -> Array:
        """Estimate those (..., 2) across and down: opposite edges are equally exact."""
        # Independent errors: one grows with the vehicle, the grid of pixels does not.
        return np.asarray(np.hypot(sides_of(edges) * self.noise, PIXEL_NOISE))
