# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Elapsed time from image stamps, the same offline and in the node.

Trackers count in nominal frame periods, so that a dropped frame or a slow camera does not change
speeds in px per second.

Stamps of serialized messages. Association of truth and estimates: by stamp, nearest first, one to
one.
"""

from __future__ import annotations

import bisect
import heapq
import math
import statistics
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from vehicle_pf_tracker.core.errors import InputError

DEFAULT_PERIOD = 1 / 30
"""Frame period in s that is assumed until stamps or a parameter give it: that of common cameras."""

_LEARNING_INTERVALS = 10
"""Intervals whose median is the period: up to four outliers, such as dropped frames, do no harm,
and at 10 frames/s the period is known after a second."""
_LONGEST_GAP = 5.0
"""Gap in s that counts in full. A longer one counts as this long: within it a vehicle has usually
crossed the view, so that extrapolating further would predict nothing."""


class StampEvent(str, Enum):
    """Irregularity of a stamp."""

    REPEATED = "repeated stamp"
    GAP = "gap in time"
    JUMP_BACK = "time jumped back"
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
        last, self._last_ns = self._last_ns, stamp_ns
        if last is None:
            return Tick(1.0)
        seconds = (stamp_ns - last) * 1e-9
        if seconds < 0:
            return Tick(1.0, StampEvent.JUMP_BACK)
        if seconds == 0:
            # One repeat is a frame delivered twice; a run of them is a camera without a clock, and
            # freezing the target for that would be worse than taking the nominal rate.
            self._repeats += 1
            return Tick(0.0 if self._repeats == 1 else 1.0, StampEvent.REPEATED)
        self._repeats = 0
        if seconds > _LONGEST_GAP:
            return Tick(self._periods(_LONGEST_GAP), StampEvent.GAP)
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


def header_stamp_ns(data: bytes | memoryview) -> int | None:
    """Read the stamp of a message in CDR that begins with a header, ns; None if it is too short."""
    if len(data) < 12:
        return None
    seconds, nanoseconds = struct.unpack_from("<iI" if data[1] & 1 else ">iI", data, 4)
    return int(seconds * 1_000_000_000 + nanoseconds)


MAX_DIFF = 0.01
"""Largest difference of associated stamps, s: well below a frame period at 30 Hz, 0.033 s."""


def is_nearest(stamp_ns: int, following_ns: int | None, moment_ns: int, limit_ns: int) -> bool:
    """Return whether a moment, at most `limit_ns` away, is no nearer to the stamp that follows."""
    distance = abs(stamp_ns - moment_ns)
    return distance <= limit_ns and (
        following_ns is None or abs(following_ns - moment_ns) >= distance
    )


def associate(first_ns: Sequence[int], second_ns: Sequence[int], max_diff: float) -> dict[int, int]:
    """Pair stamps of two lists.

    The closest pair is made first, then the closest of what is left, so that no stamp is used
    twice. Stamps need not be sorted and may repeat; of equally close ones the earlier goes first.

    Parameters
    ----------
    first_ns, second_ns : sequence of int
        Stamps in ns.
    max_diff : float
        Largest difference in s, itself allowed.

    Returns
    -------
    dict of int to int
        Index in `second_ns` by index in `first_ns`, for those that have a partner.

    Raises
    ------
    InputError
        If `max_diff` is negative or not finite.
    """
    limit = max_diff_ns(max_diff)
    free = sorted((stamp, index) for index, stamp in enumerate(second_ns))
    pairs: dict[int, int] = {}
    # A difference only grows while others are paired, so that an earlier one is a lower bound.
    waiting = [(0, i) for i in range(len(first_ns))]
    while waiting and free:
        least, i = heapq.heappop(waiting)
        difference, place = _nearest(free, first_ns[i])
        if difference == least:
            pairs[i] = free.pop(place)[1]
        elif difference <= limit:
            heapq.heappush(waiting, (difference, i))
    return dict(sorted(pairs.items()))


def max_diff_ns(max_diff: float) -> int:
    """Check a largest difference in s and return it in ns."""
    if not math.isfinite(max_diff) or max_diff < 0:
        raise InputError(f"the largest difference of stamps must be seconds >= 0, not {max_diff}")
    return round(max_diff * 1e9)


def _nearest(free: Sequence[tuple[int, int]], stamp: int) -> tuple[int, int]:
    """Return the difference in ns of the nearest free stamp, and its place; the earlier of two."""
    after = bisect.bisect_left(free, (stamp, -1))
    # Of repeated stamps the first.
    before = bisect.bisect_left(free, (free[after - 1][0], -1)) if after else after
    places = (place for place in (before, after) if place < len(free))
    return min((abs(free[place][0] - stamp), place) for place in places)
