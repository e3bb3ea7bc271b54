# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lines of a log that would come with every image, thinned out."""

from __future__ import annotations

import time
from collections.abc import Callable

_PERIOD = 5.0
"""Interval between two lines of the same kind in the log, s: a fault is seen while it lasts, and a
screen of lines holds minutes of it."""


class Notices:
    """Writes a sentence unless one of its kind was written a moment ago.

    rclpy throttles by the line of code that logs, and so cannot separate kinds.

    Parameters
    ----------
    write : callable
        Writes a line.
    clock : callable
        Steady time in s.
    """

    def __init__(
        self, write: Callable[[str], object], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._write = write
        self._clock = clock
        self._last: dict[str, float] = {}

    def say(self, kind: str, sentence: str) -> None:
        """Write `sentence`, one of few kinds."""
        now = self._clock()
        if now - self._last.get(kind, -_PERIOD) >= _PERIOD:
            self._last[kind] = now
            self._write(sentence)
