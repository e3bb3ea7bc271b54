# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes of parts of a vehicle, and of several vehicles at once.

Blobs and networks give boxes of a bonnet, of a vehicle with and without its shadow, or one box of
two vehicles that enter side by side.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.trackers.traffic.box_edges import INWARD_SIGNS, both_ends, sides_of
from vehicle_pf_tracker.trackers.traffic.edge_observation import Edge
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers
from vehicle_pf_tracker.trackers.traffic.tracks import Drives, Tracks

_INSIDE = 0.7
"""Share of a box inside another one above which it is a part of it: a bonnet, a second box. A
choice: vehicles side by side share less, and edges err by a twentieth each."""
_TOUCHES = 0.1
"""Share of a box that overlaps another one below which they are beside each other: two edges at the
usual noise of a twentieth."""
_CROWDED_FOR = 4
"""Images in a row by which a box is of several vehicles, or of more than was known: fewer may be
wrong."""
_OFTEN_ALONE = 0.5
"""Images with a box around a vehicle, per detection of its own, above which it was always larger
than known: two that drive side by side are one box for a while, too."""
_REST_REACH = 0.5
"""Distance, of its size, within which the rest of a piece is."""
_LEAST_REST = 0.25
"""Least area of a rest, of the piece's own: less is a speck. Chosen on a close scene."""


def have_rest(edges: Array, others: Array) -> Bools:
    """Find boxes (N, 4) among `others` (M, 4), all, that have another one beside them."""
    reach = _REST_REACH * both_ends(sides_of(edges))
    near = intersections((edges - reach * INWARD_SIGNS)[:, np.newaxis], others) > 0
    near &= areas(others) > _LEAST_REST * areas(edges)[:, np.newaxis]  # a speck is no rest
    return np.asarray(near.sum(axis=1) > 1)  # itself is one


def inside_of(boxes: Array, edges: Array, *, either: bool = False) -> Bools:
    """Find boxes (N,) among `edges` (N, 4) that are inside one of `boxes` (M, 4), or `either`."""
    each = edges[:, np.newaxis]
    # The larger may be around: in either case most of the smaller is shared.
    smaller = np.minimum(areas(boxes), areas(each)) if either else areas(each)
    return np.asarray((intersections(each, boxes) > _INSIDE * smaller).any(axis=1))


def shrink_joined(drives: Drives, edges: Array, others: Array) -> Drives:
    """Shrink boxes of several vehicles that were taken for one to the nearest one's.

    Vehicles that enter the image side by side are one blob, and drive apart later. The detection of
    one is then no part of a larger vehicle whose rest is hidden: the rest is there, behind it.

    Parameters
    ----------
    drives : Drives
        Drives of N vehicles, predicted into this frame.
    edges : (N, 4) array
        Edges of the detection of each, px.
    others : (M, 4) array
        Edges of all detections.
    """
    predicted = drives.gaussians.edges
    # Another detection within the prediction, apart from its own, and farther away: nothing that
    # its own detection shows could hide it, so the prediction is of both.
    within = intersections(predicted[:, np.newaxis], others)
    rows, columns = (within > _TOUCHES * areas(predicted)[:, np.newaxis]).nonzero()
    own = edges[rows]
    other = others[columns]
    is_rest = intersections(own, other) < _TOUCHES * areas(other)
    is_rest &= other[:, Edge.BOTTOM] < own[:, Edge.BOTTOM]
    beside = np.zeros(len(edges), np.bool_)
    beside[rows[is_rest]] = True
    # Its own has to lie in the prediction, too: else that is just wrong.
    known = intersections(predicted, edges) > _INSIDE * areas(edges)
    # In a row: one box of a neighbour that touches does not count for ever.
    crowded = np.where(known & beside, drives.extents.crowded + 1, 0)
    # It has a detection of its own: no box around it was meant for it so far.
    enclosed = np.zeros(len(crowded), np.intp)
    extents = replace(drives.extents, crowded=crowded, enclosed=enclosed)
    drives = replace(drives, extents=extents)
    several = np.flatnonzero(crowded >= _CROWDED_FOR)
    return _resized(drives, several, edges[several]) if len(several) else drives


def _resized(drives: Drives, rows: Integers, edges: Array) -> Drives:
    """Set the boxes of the vehicles at `rows` (K,) to `edges` (K, 4) in px."""
    extents = drives.extents
    crowded = extents.crowded.copy()
    enclosed = extents.enclosed.copy()
    shown = extents.shown.copy()
    # The size is now all that is seen, so that no edge is taken for covered by what was a
    # neighbour.
    crowded[rows] = 0
    enclosed[rows] = 0
    shown[rows] = 1.0
    resized = drives.gaussians.take(rows).resized(edges)
    return replace(
        drives,
        gaussians=drives.gaussians.put(rows, resized),
        extents=replace(extents, crowded=crowded, enclosed=enclosed, shown=shown),
    )


def grow_to_enclosing(tracks: Tracks, edges: Array) -> tuple[Tracks, Integers]:
    """Find those that were known by a part only, and make each as large as the box around it.

    Where something hides a vehicle at first, or the background has its colour, it is followed by
    what is seen; a box of all of it then is too large to be its own.

    Parameters
    ----------
    tracks : Tracks
        All tracks.
    edges : (M, 4) array
        Edges of the detections that are no vehicle's, px.

    Returns
    -------
    Tracks, (K,) array
        All, and the rows of those that have outgrown.
    """
    # 1. Boxes around exactly one vehicle: around two it would be a box of both.
    none = np.zeros(0, np.intp)
    confirmed = np.flatnonzero(tracks.confirmed)
    if not (len(confirmed) and len(edges)):
        return tracks, none
    boxes = tracks.edges[confirmed]
    common = intersections(edges[:, np.newaxis], boxes)
    alone = (common > 0).sum(axis=1, keepdims=True) == 1
    around = alone & (common > _INSIDE * areas(boxes))
    # 2. Only those that nothing else was given to; what has a detection of its own fits.
    waits = (~tracks.detected & tracks.in_sight)[confirmed]
    drives = tracks.drives
    matches = tracks.beliefs.paths.matches
    # 3. Not in the first image, nor if it was usually detected as it is: two vehicles that drive
    # side by side are one box for a while.
    # Several boxes may be around one vehicle: the image counts once, by the first of them.
    vehicles, columns = np.nonzero((around & waits).T)
    if not len(vehicles):
        return tracks, none
    vehicles, first = np.unique(vehicles, return_index=True)
    rows = confirmed[vehicles]
    enclosed = drives.extents.enclosed.copy()
    enclosed[rows] += 1
    due = enclosed[rows] >= np.maximum(_CROWDED_FOR, _OFTEN_ALONE * matches[rows])
    drives = replace(drives, extents=replace(drives.extents, enclosed=enclosed))
    if due.any():
        drives = _resized(drives, rows[due], edges[columns[first][due]])
    return replace(tracks, drives=drives), rows[due]
