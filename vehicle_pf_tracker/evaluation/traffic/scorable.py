# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes that can be scored: of vehicles in sight, in the image, where the truth is known."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.evaluation.traffic.box_matches import edges_of, matches
from vehicle_pf_tracker.evaluation.traffic.sequence import EVERY_FRAME, TrafficSequence

_MOST_INSIDE = 0.5
"""Share of an unmatched box in a region without truth above which it is left out: most of it is
not known to be wrong."""


def scorable(sequence: TrafficSequence, tracks: Array) -> tuple[Array, Array]:
    """Leave out what cannot be scored.

    Truth ends at the image's borders, and so boxes are cut there; those outside are left out.
    Totally hidden vehicles are not scored. A track's box that belongs to no vehicle in sight is
    left out where it belongs to a hidden one, or where most of it lies in a region without truth.

    Parameters
    ----------
    sequence : TrafficSequence
        Scene with truth.
    tracks : array, shape (N, 6) or wider
        Frame, identity, left, top, width and height of the tracks' boxes.

    Returns
    -------
    truth, tracks : array, shape (M, 6)
        Boxes to be scored.
    """
    # Cut first: regions and overlaps are of what is in the image, as the truth is.
    tracks = _cut(tracks[:, :6], sequence.size)
    left = np.ones(len(tracks), dtype=np.bool_)
    for frame in range(1, sequence.frame_count + 1):
        rows = np.flatnonzero(tracks[:, 0] == frame)
        left[rows] = _are_scored(sequence, frame, tracks[rows, 2:6])
    return sequence.truth[~sequence.hidden], tracks[left]


def _cut(tracks: Array, size: tuple[int, int]) -> Array:
    # A vehicle that drives out is tracked beyond the border, where the truth ends.
    low = np.maximum(tracks[:, 2:4], 0)
    high = np.minimum(tracks[:, 2:4] + tracks[:, 4:6], size)
    inside = (high > low).all(axis=1)
    cut: Array = np.hstack([tracks[:, :2], low, high - low])[inside]
    return cut


def _are_scored(sequence: TrafficSequence, frame: int, boxes: Array) -> npt.NDArray[np.bool_]:
    """Mark the boxes of one frame that are scored."""
    now = sequence.truth[:, 0] == frame
    in_sight = sequence.truth[now & ~sequence.hidden, 2:]
    hidden = sequence.truth[now & sequence.hidden, 2:]
    # Vehicles in sight come first: a box that fits one of them is scored, whatever is behind.
    free = np.ones(len(boxes), dtype=np.bool_)
    free[matches(in_sight, boxes)[1]] = False
    spare = np.flatnonzero(free)
    left_out = np.zeros(len(boxes), dtype=np.bool_)
    left_out[spare[matches(hidden, boxes[spare])[1]]] = True
    # Regions of this frame, and those of all.
    regions = sequence.ignored[np.isin(sequence.ignored[:, 0], (EVERY_FRAME, frame)), 1:]
    common = intersections(edges_of(boxes)[:, None], edges_of(regions))
    inside = common > _MOST_INSIDE * boxes[:, 2:].prod(axis=1)[:, None]
    left_out |= free & inside.any(axis=1)
    return ~left_out
