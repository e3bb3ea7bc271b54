# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Two pieces of work measured in turns, so that what slows the machine down slows both."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeAlias

from benchmarks.bench.case import Case

Work: TypeAlias = Callable[[int], object]
"""Does one piece of work; the number of the round lets it take another input each time."""

_CALLS_FOR = 5e-3
"""CPU seconds that a round repeats its work for, at least: both then run from caches of their own,
instead of the shorter one paying each time for what the longer one left there."""
_LEAST_ROUNDS = 9
"""Rounds at least, also of slow work: quartiles of fewer say nothing."""
_MOST_ROUNDS = 301
"""Rounds at most: the median of more moves less than the machine does."""


def compare(name: str, ours: Work, baseline: Work, seconds: float) -> Case:
    """Measure two pieces of work in turns for about `seconds`.

    Both are called once before anything counts. Each round takes CPU time of this thread alone,
    and the order within it changes from round to round.
    """
    works = ours, baseline
    # Repeated by its own length: a round of the shorter work is not lost in the clock's steps.
    calls = [_calls(work) for work in works]
    times: tuple[list[float], list[float]] = ([], [])
    deadline = time.monotonic() + seconds
    for number in range(_MOST_ROUNDS):
        if number >= _LEAST_ROUNDS and time.monotonic() > deadline:
            break
        # The order alternates: the second may find caches that the first has warmed, or emptied.
        for side in (0, 1) if number % 2 else (1, 0):
            times[side].append(_cpu_seconds(works[side], number, calls[side]))
    return Case.of(name, *times)


def _calls(work: Work) -> int:
    work(0)
    # At least 0.1 µs: a clock that has not moved would ask for endless repetitions.
    return max(round(_CALLS_FOR / max(_cpu_seconds(work, 0, 1), 1e-7)), 1)


def _cpu_seconds(work: Work, number: int, calls: int) -> float:
    # Of the thread: what other processes take from the machine does not count.
    before = time.thread_time()
    for index in range(calls):
        work(number + index)
    return (time.thread_time() - before) / calls
