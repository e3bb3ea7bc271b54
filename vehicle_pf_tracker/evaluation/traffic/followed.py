# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that were never found, and numbers that were on no vehicle."""

from __future__ import annotations

from collections import Counter as Tally

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.traffic.box_matches import matches
from vehicle_pf_tracker.evaluation.traffic.scorable import scorable
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence

_LEAST_ON_VEHICLES = 0.3
"""Share of a number's boxes that fit a vehicle, from which it is no false one. A choice, below a
half: boxes that are loose for some time fit nothing, though there is a vehicle."""


def never_found(sequence: TrafficSequence, tracks: Array) -> tuple[int, int]:
    """Count vehicles in sight that no box fitted in any image.

    Returns
    -------
    missed, vehicles : int
        Those, and all that were ever in sight.
    """
    vehicles = np.unique(sequence.truth[~sequence.hidden, 1])
    fitted = {vehicle for vehicle, _ in _fitting(sequence, tracks)[0]}
    return len(vehicles) - len(fitted), len(vehicles)


def false_numbers(sequence: TrafficSequence, tracks: Array) -> int:
    """Count identities of which fewer than `_LEAST_ON_VEHICLES` of the boxes fit a vehicle.

    Boxes that cannot be scored, such as those on hidden vehicles, are left out.
    """
    pairs, boxes = _fitting(sequence, tracks)
    on_vehicles = Tally(identity for _, identity in pairs)
    return sum(
        on_vehicles[identity] < _LEAST_ON_VEHICLES * count for identity, count in boxes.items()
    )


def _fitting(sequence: TrafficSequence, tracks: Array) -> tuple[list[tuple[int, int]], Tally[int]]:
    """Vehicle and identity of each pair that fits in an image, and boxes by identity."""
    truth, rows = scorable(sequence, tracks)
    pairs: list[tuple[int, int]] = []
    for frame in range(1, sequence.frame_count + 1):
        vehicles = truth[truth[:, 0] == frame]
        boxes = rows[rows[:, 0] == frame]
        for row, column in zip(*matches(vehicles[:, 2:], boxes[:, 2:6]), strict=True):
            pairs.append((int(vehicles[row, 1]), int(boxes[column, 1])))
    return pairs, Tally(rows[:, 1].astype(int).tolist())
