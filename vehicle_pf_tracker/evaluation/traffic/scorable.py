# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Boxes of many vehicles made ready for scores: what has no truth is left out."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.traffic.sequence import EVERY_FRAME, TrafficSequence

MATCH = 0.5
"""Least overlap (intersection over union) of boxes that belong to each other: MOTChallenge's."""

_MOST_INSIDE = 0.5
"""Share of an unmatched box in a region without truth above which it is left out."""


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
    tracks = _cut(tracks[:, :6], sequence.size)
    left = np.ones(len(tracks), dtype=np.bool_)
    for frame in range(1, sequence.frame_count + 1):
        rows = np.flatnonzero(tracks[:, 0] == frame)
        left[rows] = _counts(sequence, frame, tracks[rows, 2:6])
    return sequence.truth[~sequence.hidden], tracks[left]


def _cut(tracks: Array, size: tuple[int, int]) -> Array:
    low = np.maximum(tracks[:, 2:4], 0)
    high = np.minimum(tracks[:, 2:4] + tracks[:, 4:6], size)
    inside = (high > low).all(axis=1)
    cut: Array = np.hstack([tracks[:, :2], low, high - low])[inside]
    return cut


def _counts(sequence: TrafficSequence, frame: int, boxes: Array) -> npt.NDArray[np.bool_]:
    """Mark the boxes of one frame that are scored."""
    now = sequence.truth[:, 0] == frame
    in_sight = sequence.truth[now & ~sequence.hidden, 2:]
    hidden = sequence.truth[now & sequence.hidden, 2:]
    free = np.ones(len(boxes), dtype=np.bool_)
    free[matches(in_sight, boxes)[1]] = False
    spare = np.flatnonzero(free)
    left_out = np.zeros(len(boxes), dtype=np.bool_)
    left_out[spare[matches(hidden, boxes[spare])[1]]] = True
    regions = sequence.ignored[np.isin(sequence.ignored[:, 0], (EVERY_FRAME, frame)), 1:]
    inside = common_areas(boxes, regions) > _MOST_INSIDE * boxes[:, 2:].prod(axis=1)[:, None]
    left_out |= free & inside.any(axis=1)
    return ~left_out


def matches(first: Array, second: Array) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Match boxes one to one so that the sum of overlaps of at least `MATCH` is largest.

    Returns
    -------
    array of int, array of int
        Indices into `first` and `second`.
    """
    overlap = overlaps(first, second)
    overlap[overlap < MATCH] = 0
    rows, columns = linear_sum_assignment(-overlap)
    good = overlap[rows, columns] > 0
    return rows[good], columns[good]


def overlaps(first: Array, second: Array) -> Array:
    """Intersection over union of each pair of boxes (left, top, width, height)."""
    common = common_areas(first, second)
    union = first[:, None, 2:].prod(axis=2) + second[None, :, 2:].prod(axis=2) - common
    overlap: Array = common / np.maximum(union, np.finfo(float).eps)
    return overlap


def common_areas(first: Array, second: Array) -> Array:
    """Area that each pair of boxes (left, top, width, height) has in common, px²."""
    low = np.maximum(first[:, None, :2], second[None, :, :2])
    high = np.minimum(
        first[:, None, :2] + first[:, None, 2:], second[None, :, :2] + second[None, :, 2:]
    )
    common: Array = np.clip(high - low, 0, None).prod(axis=2)
    return common
