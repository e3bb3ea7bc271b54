# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Elapsed time from image stamps, the same offline and in the node.

Trackers count in nominal frame periods, so that a dropped frame or a slow camera does not change
speeds in px per second.
"""

from __future__ import annotations

import statistics
from dataclasses import dataclass
from enum import Enum

DEFAULT_PERIOD = 1 / 30
"""Frame period in s that is assumed until stamps or a parameter give it: that of common cameras."""

_LEARNING_INTERVALS = 10
"""Intervals whose median is the period: up to four outliers, such as dropped frames, do no harm,
and at 10 frames/s the period is known after a second."""
_LONGEST_GAP = 5.0
"""Gap in s that counts in full. A longer one counts as this long: within it a vehicle has usually
crossed the view, so that extrapolating further would predict nothing."""
_SHORTEST_LOOP = 1.0
"""Time in s back from which a recording may begin again. By less a clock was corrected, or two
cameras publish in turns: neither is a reason to lose a target. No recording is this short."""


class StampEvent(str, Enum):
    """Irregularity of a stamp."""

    REPEATED = "repeated stamp"
    GAP = "gap in time"
    JUMP_BACK = "time jumped back"
    SET_BACK = "time went back by less than a second, as if the clock was set"
    UNUSABLE = "unusable stamps, so each image counts as one period"


@dataclass(frozen=True, slots=True)
class Tick:
    """Time since the previous frame in nominal frame periods, and irregularity of the stamp."""

    elapsed: float
    event: StampEvent | None = None


class StampClock:
    """Conversion of stamps to elapsed nominal frame periods.

    Parameters
    ----------
    frame_rate : float
        Nominal rate in 1/s. 0 takes the median of the first ten intervals; until those are known
        every frame counts as one period.
    """

    def __init__(self, frame_rate: float) -> None:
        self._given = 1 / frame_rate if frame_rate else None
        self._learned: float | None = None
        self._intervals: list[float] = []
        self._last_ns: int | None = None
        self._repeats = 0

    @property
    def period(self) -> float | None:
        """Nominal frame period in s; None while it is not known."""
        return self._given or self._learned

    def set_frame_rate(self, frame_rate: float) -> None:
        """Take a nominal rate in 1/s, or go back to the measured one with 0."""
        self._given = 1 / frame_rate if frame_rate else None

    def tick(self, stamp_ns: int) -> Tick:
        """Take the stamp of the next frame, in ns."""
        last = self._last_ns
        self._last_ns = stamp_ns
        if last is None:
            return Tick(1.0)
        # Integers are subtracted first: stamps of today have more digits than a float64.
        seconds = (stamp_ns - last) * 1e-9
        if seconds < 0:
            # The frame after a jump is a new one: what repeats it is delivered twice again.
            self._repeats = 0
            loops = seconds <= -_SHORTEST_LOOP
            return Tick(1.0, StampEvent.JUMP_BACK if loops else StampEvent.SET_BACK)
        if seconds == 0:
            # One repeat is a frame delivered twice; a run of them is a camera without a clock, and
            # freezing the target for that would be worse than taking the nominal rate.
            self._repeats += 1
            return Tick(0.0 if self._repeats == 1 else 1.0, StampEvent.REPEATED)
        self._repeats = 0
        if seconds > _LONGEST_GAP:
            return Tick(self._periods(_LONGEST_GAP), StampEvent.GAP)
        # By the period known before: the interval itself must not change its own measure.
        elapsed = self._periods(seconds)
        self._learn(seconds)
        return Tick(elapsed)

    def _periods(self, seconds: float) -> float:
        return seconds / self.period if self.period else 1.0

    def _learn(self, seconds: float) -> None:
        if self._learned is not None:
            return
        self._intervals.append(seconds)
        if len(self._intervals) == _LEARNING_INTERVALS:
            self._learned = statistics.median(self._intervals)
