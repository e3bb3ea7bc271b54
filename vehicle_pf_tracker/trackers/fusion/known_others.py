# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Other vehicles that were in view when one was hidden, followed by their outlines.

The car ahead often has the same shape and paint, and the hypotheses gather at it. It is known by
where it was; where its outline merges with another, it is where it would be at its velocity.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import overlaps as edge_overlaps
from vehicle_pf_tracker.trackers.fusion.outline_boxes import areas

_LARGEST_CHANGE = 1.5
"""Factor of the area of an outline, to that when the vehicle was hidden, beyond which it has merged
with another one, or is cut: half a vehicle more or less. The half is a choice."""
_LEAST_OVERLAP = 0.5
"""Least overlap (intersection over union) of an outline with its predicted place: two in a lane are
a length apart, and share nothing. The half is a choice."""
_REMEMBERED = 30.0
"""Periods for which another vehicle is expected at its velocity while its outline is merged: a
second at 30 Hz, a choice; by then what merged has mostly come apart."""
_MIDDLE = 0.5
"""Middle part of a box, fraction of each side, that no other vehicle has its centre in: the box of
one close behind overlaps it by its shadow, but its centre is at least half a length away."""


class KnownOthers(NamedTuple):
    """Bounding boxes of vehicles that are not the hidden one.

    Attributes
    ----------
    first, latest : (N, 2, 2) arrays
        Their boxes (low, high; px) when the vehicle was hidden, and when they were seen last.
    began : float
        Age of the first of them, periods.
    ages : (N,) array
        Ages of the latest.
    """

    first: Array = np.empty((0, 2, 2))
    latest: Array = np.empty((0, 2, 2))
    began: float = 0.0
    ages: Array = np.empty(0)

    @classmethod
    def begun(cls, boxes: Array, age: float) -> KnownOthers:
        """Begin with the boxes (N, 2, 2) of an age."""
        return cls(boxes, boxes, age, np.full(len(boxes), age))

    def seen(self, boxes: Array, age: float) -> KnownOthers:
        """Find them among the boxes (M, 2, 2) of an age."""
        fresh = age - self.ages < _REMEMBERED
        if not fresh.any():
            return KnownOthers()
        first = self.first[fresh]
        latest = self.latest[fresh].copy()
        ages = self.ages[fresh].copy()
        if len(boxes):
            overlaps = edge_overlaps(
                self._places(age)[fresh].reshape(-1, 1, 4), boxes.reshape(-1, 4)
            )
            best = overlaps.argmax(axis=1)
            change = np.abs(np.log(areas(boxes)[best] / areas(first)))
            found = (overlaps.max(axis=1) > _LEAST_OVERLAP) & (change < np.log(_LARGEST_CHANGE))
            latest[found] = boxes[best[found]]
            ages[found] = age
        return KnownOthers(first, latest, self.began, ages)

    def has(self, positions: Array, age: float) -> npt.NDArray[np.bool_]:
        """Test which positions (..., 2) are in the middle of one of them."""
        if not len(self.first):
            return np.zeros(positions.shape[:-1], bool)
        places = self._places(age)
        middles = places.mean(axis=1)
        reach = _MIDDLE / 2 * (places[:, 1] - places[:, 0])
        inside = np.abs(positions[..., np.newaxis, :] - middles) < reach
        return np.asarray(inside.all(axis=-1).any(axis=-1))

    def _places(self, age: float) -> Array:
        """Boxes at an age, at constant velocity since they were seen last."""
        spans = np.maximum(self.ages - self.began, 1.0)
        moved = (self.latest - self.first).mean(axis=1) / spans[:, np.newaxis]
        since = (age - self.ages)[:, np.newaxis]
        return np.asarray(self.latest + (moved * since)[:, np.newaxis])
