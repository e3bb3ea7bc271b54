# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Time without images: how long it has lasted, and the waits before the source is tried again."""

from __future__ import annotations

import threading
import time

_FIRST_WAIT = 1.0
"""Seconds before the first try: a stream that lost its connection is back at once."""
_LONGEST_WAIT = 30.0
"""Longest wait in s. Each is twice as long as the last: a camera that restarts is back within a
minute, and one that is gone costs next to nothing."""


class Outage:
    """Waits, longer each time, until images come again.

    Parameters
    ----------
    stop : threading.Event
        Ends every wait.

    Attributes
    ----------
    next_wait : float
        Length of the next wait, s.
    """

    def __init__(self, stop: threading.Event) -> None:
        self.next_wait = _FIRST_WAIT
        self._stop = stop
        self._began: float | None = None

    def begin(self) -> None:
        """Note that there are no images, since now unless it was noted before."""
        if self._began is None:
            self._began = time.monotonic()

    def wait(self) -> None:
        """Wait before the next try."""
        self._stop.wait(self.next_wait)
        self.next_wait = min(2 * self.next_wait, _LONGEST_WAIT)

    def end(self) -> float | None:
        """Note that an image came; return how long there was none, s, if that is the first."""
        began = self._began
        self._began = None
        self.next_wait = _FIRST_WAIT
        return None if began is None else time.monotonic() - began
