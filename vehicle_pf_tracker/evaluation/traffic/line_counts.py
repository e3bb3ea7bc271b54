# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Counts at many lines over the picture of a scene with truth, and how well they are trusted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.counting.count_signs import Sign
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.evaluation.traffic.middle_line import as_estimate
from vehicle_pf_tracker.evaluation.traffic.sequence import EVERY_FRAME, TrafficSequence
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession

_ROWS = (0.2, 0.35, 0.5, 0.65, 0.8)
"""Heights of lines across the whole image, as shares of it: far and near traffic. A choice, as
those below: even steps, without the rims, where vehicles are cut."""
_COLUMNS = (0.25, 0.5, 0.75)
"""Places of upright lines, as shares of the width, for traffic across the image."""
_HALVES = (0.3, 0.45, 0.6, 0.75)
"""Heights of lines across the left and the right half, as shares, as of one carriageway."""


@dataclass(frozen=True, slots=True)
class LineCount:
    """Count at a line in one direction.

    Attributes
    ----------
    true, counted : int
        Crossings of the true boxes, and of the vehicles that were followed.
    interval : (int, int)
        Least and largest likely true number.
    signs : mapping of Sign to int
        Signs that the interval is made of.
    """

    true: int
    counted: int
    interval: tuple[int, int]
    signs: dict[Sign, int]

    @property
    def is_judged(self) -> bool:
        """True where anything crossed; elsewhere an interval from 0 to 0 proves nothing."""
        return bool(self.true or self.counted)

    @property
    def is_held(self) -> bool:
        """True where the interval holds the true number."""
        low, high = self.interval
        # Ends included, as `Trust.interval` gives them.
        return low <= self.true <= high


class LineCounts:
    """Counts the vehicles of a scene at all lines, while they are followed.

    Parameters
    ----------
    sequence : TrafficSequence
        The scene.
    """

    def __init__(self, sequence: TrafficSequence) -> None:
        self._sequence = sequence
        self._plan = _plan(sequence.size)
        self._counter = Counter(self._plan)
        regions = sequence.ignored
        self._ignored = regions[regions[:, 0] == EVERY_FRAME, 1:]
        self._first = 0

    def add(self, number: int, stamp_ns: int, session: TrafficSession) -> None:
        """Take what a session has estimated of an image; there is no truth before it looked."""
        if not session.detected.images:
            return
        self._first = self._first or number
        # In regions without truth a crossing would count as false.
        known = [vehicle for vehicle in session.estimates if not self._is_ignored(vehicle.position)]
        self._counter.update(known, stamp_ns, ambiguous=session.ambiguous)

    def results(self) -> list[LineCount]:
        """Return the counts at each line in each direction."""
        true = self._true_counter()
        counter = self._counter
        return [
            LineCount(
                true=true.count(line.name, to),
                counted=counter.count(line.name, to),
                interval=counter.interval(line.name, to),
                signs=dict(counter.signs(line.name, to)),
            )
            for line in self._plan.lines
            for to in line.directions
        ]

    def _is_ignored(self, point: Position) -> bool:
        low = self._ignored[:, :2]
        inside = (point >= low) & (point <= low + self._ignored[:, 2:])
        return bool(inside.all(axis=1).any())

    def _true_counter(self) -> Counter:
        sequence = self._sequence
        counter = Counter(self._plan)
        # In the same order in each image, whatever the file has: the same crossings in doubt.
        rows = sequence.truth[np.argsort(sequence.truth[:, 1], kind="stable")]
        # From the same image on: what crossed while the detector learnt is no miss of the count.
        for number in range(max(self._first, 1), sequence.frame_count + 1):
            now = rows[rows[:, 0] == number]
            stamp_ns = round(number * 1e9 / sequence.frame_rate)
            counter.update([as_estimate(row) for row in now.tolist()], stamp_ns)
        return counter


def held_and_width(counts: Sequence[LineCount]) -> tuple[float, float] | None:
    """Return the percentage of intervals that hold the truth, and their mean width.

    None where nothing truly crosses a line.
    """
    judged = [count for count in counts if count.is_judged]
    if not any(count.true for count in judged):
        return None
    # Each line weighs alike: a busy one does not stand for its scene.
    held = np.mean([count.is_held for count in judged])
    width = np.mean([count.interval[1] - count.interval[0] for count in judged])
    return 100 * float(held), float(width)


def _plan(size: tuple[int, int]) -> CountingPlan:
    width, height = map(float, size)
    across = [((0.0, at * height), (width, at * height)) for at in _ROWS]
    upright = [((at * width, 0.0), (at * width, height)) for at in _COLUMNS]
    left = [((0.0, at * height), (width / 2, at * height)) for at in _HALVES]
    right = [((width / 2, at * height), (width, at * height)) for at in _HALVES]
    ends = [*across, *upright, *left, *right]
    return CountingPlan(lines=tuple(CountingLine(str(k), *each) for k, each in enumerate(ends)))
