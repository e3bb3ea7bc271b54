# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles counted at a line through the middle of the image."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_SETTLED_NS = 2 * 10**9
"""Time in ns before which crossings are not counted, a choice: who is on the line when a clip
begins has no past."""


def middle_crossings(sequence: TrafficSequence, tracks: Array) -> tuple[int, int]:
    """Count crossings of a line through the middle of the image, after the first two seconds.

    Returns
    -------
    counted, true : int
        Crossings of the tracks and of the true boxes, in both directions.
    """
    line = _line(sequence)
    return _crossings(sequence, tracks, line), _crossings(sequence, sequence.truth, line)


def _line(sequence: TrafficSequence) -> CountingLine:
    """Return the line through the middle that most of the true motion crosses."""
    width, height = map(float, sequence.size)
    moved = np.zeros(2)
    for vehicle in np.unique(sequence.truth[:, 1]):
        boxes = sequence.truth[sequence.truth[:, 1] == vehicle, 2:]
        moved += np.abs(boxes[-1, :2] - boxes[0, :2])
    # Sums over all vehicles: an upright line for traffic across the image.
    if moved[0] > moved[1]:
        return CountingLine("middle", (width / 2, 0.0), (width / 2, height))
    return CountingLine("middle", (0.0, height / 2), (width, height / 2))


def _crossings(sequence: TrafficSequence, tracks: Array, line: CountingLine) -> int:
    counter = Counter(CountingPlan(lines=(line,)))
    # In the order of identities, so that truth and tracks are counted alike.
    order = np.argsort(tracks[:, 1], kind="stable")
    rows = tracks[order]
    total = 0
    for frame in range(1, sequence.frame_count + 1):
        now = rows[rows[:, 0] == frame]
        estimates = [as_estimate(row) for row in now.tolist()]
        crossings = counter.update(estimates, round(frame * 1e9 / sequence.frame_rate))
        # The counter follows from the first frame; only its crossings of before are left out.
        total += sum(
            crossing.stamp_ns >= _SETTLED_NS and not crossing.doubt for crossing in crossings
        )
    return total


def as_estimate(row: list[float]) -> TrackEstimate:
    """Take a row (frame, identity, left, top, width, height) for a vehicle in sight."""
    return TrackEstimate(
        identity=int(row[1]),
        box=Box(*row[2:6]),
        velocity=(0.0, 0.0),
        mode=TrackMode.TRACKING,
        confidence=1.0,
        label="",
        score=1.0,
        age=1.0,
        hidden_by=None,
        serial=int(row[1]),
    )
