# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that hide one another.

Of two vehicles, the one whose lower edge is nearer on the road hides the other.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import NO_BOXES, areas, inside_image
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers, filled
from vehicle_pf_tracker.trackers.traffic.state import State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks, Visibility

_HIDES_WITHIN = 4.0
"""Nominal periods since a vehicle was seen within which it hides others. A choice: more than the
one or two that a detector misses by chance; later its own place is a guess, which must not excuse
what is missed there."""
_GOOD_PART = 0.5
"""Share of a box above which what covers it is said to hide the vehicle: most of it."""


def find_occlusions(state: State, step: Step) -> State:
    """Note how much of each vehicle is in sight, and order vehicles by their distance.

    Nearer boxes hide others: a detector that does not see these says nothing against them.
    """
    # Sorted by distance, one triangle of the matrix of overlaps says who hides whom. The order is
    # kept in the state: from frame to frame it rarely changes, and nothing is copied then.
    tracks = state.tracks.take(nearest_first(state.tracks, step.road))
    edges = tracks.edges
    hiding = np.flatnonzero(_hides(tracks) & step.parameters.occlusions)
    common = intersections(edges[:, np.newaxis], edges[hiding]) / areas(edges)[:, np.newaxis]
    # A vehicle hides neither itself nor a nearer one.
    common[np.arange(len(tracks))[:, np.newaxis] <= hiding] = 0.0
    # A sum of shares, no union: where occluders overlap one another, less seems to be seen than is.
    uncovered = np.maximum(1 - common.sum(axis=1), 0.0)
    hidden_by = np.zeros(len(tracks), np.intp)
    covers = filled(len(tracks), NO_BOXES)
    rows = (uncovered < 1).nonzero()[0]
    if len(rows):
        is_named = common.max(axis=1) > _GOOD_PART
        hidden_by[is_named] = tracks.names.identity[hiding[common.argmax(axis=1)]][is_named]
        # Kept beside the share: pixels and colours leave out just these boxes.
        covered, over = (common > 0).nonzero()
        boxes = edges[hiding[over]]
        first = covered.searchsorted(rows).tolist()
        last = covered.searchsorted(rows, "right").tolist()
        for row, start, end in zip(rows.tolist(), first, last, strict=True):
            covers[row] = boxes[start:end]
    visibility = Visibility(
        uncovered=uncovered,
        inside=inside_image(edges, step.size),
        covers=covers,
        hidden_by=hidden_by,
    )
    return state._replace(tracks=replace(tracks, visibility=visibility))


def nearest_first(tracks: Tracks, road: RoadPlane | None) -> Integers:
    """Order (N,) of vehicles by their distance from the camera.

    Parameters
    ----------
    tracks : Tracks
        Vehicles.
    road : RoadPlane or None
        Road that they stand on; None: the lower a vehicle stands in the image, the nearer it is.
    """
    edges = tracks.edges
    # What a lens cannot show is out of the image, and last.
    distances = -edges[:, 3] if road is None else np.nan_to_num(-_nearness(edges, road), nan=np.inf)
    # Equally far ones by age: an order that depends on nothing else repeats.
    return np.asarray(np.lexsort((tracks.names.serial, distances)))


def _nearness(edges: Array, road: RoadPlane) -> Array:
    # A box stands on the road in the middle of its lower edge.
    feet = np.column_stack([(edges[:, 0] + edges[:, 2]) / 2, edges[:, 3]])
    return np.asarray(road.homography.nearness(road.ideal(feet)))


def _hides(tracks: Tracks) -> Bools:
    absences = tracks.absences
    # Tentative tracks hide nothing: a false alarm would excuse missed detections behind it.
    is_known = (absences.unseen < _HIDES_WITHIN) & ~absences.lost
    return np.asarray(tracks.confirmed & is_known)
