# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pace of a source: when each of its images is due, and the stamp that it gets."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable


class SourcePace:
    """Stamps for the images of one pass through a source.

    Images of a file keep the intervals that it states: the first is stamped by the clock, and the
    others follow, so that stamps do not carry the jitter of this process. Live images are stamped
    by the clock as they come.

    Parameters
    ----------
    clock : callable
        Returns the present time in ns.
    stop : threading.Event
        Ends every wait.
    """

    def __init__(self, clock: Callable[[], int], stop: threading.Event) -> None:
        self._clock = clock
        self._stop = stop
        self._is_live = False
        self._began: tuple[int, int, float] | None = None
        self.last = 0

    def begin(self, *, is_live: bool) -> None:
        """Begin a pass, of images that come by themselves where `is_live`."""
        self._began = None
        self._is_live = is_live

    def stamp(self, recorded_ns: int) -> int:
        """Return the stamp of an image with the source's own time, once it is due.

        It is later than any before. Returns early when the process ends.
        """
        if self._is_live:
            self.last = max(self._clock(), self.last + 1)
            return self.last
        if self._began is None:
            self._began = recorded_ns, max(self._clock(), self.last + 1), time.monotonic()
        first, stamped, when = self._began
        passed = recorded_ns - first
        self._stop.wait(max(when + passed / 1e9 - time.monotonic(), 0.0))
        self.last = stamped + passed
        return self.last
