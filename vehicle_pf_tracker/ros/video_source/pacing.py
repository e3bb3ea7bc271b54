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

"""Stamps of published images, and the moment at which each is due."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable


class Pace:
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
        self._clock, self._stop, self._is_live = clock, stop, False
        self._began: tuple[int, int, float] | None = None
        self.last = 0

    def begin(self, *, is_live: bool) -> None:
        """Begin a pass, of images that come by themselves where `is_live`."""
        self._began, self._is_live = None, is_live

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


class BackOff:
    """Waits before one more try, twice as long as before the last.

    Parameters
    ----------
    stop : threading.Event
        Ends every wait.
    shortest, longest : float
        First wait, and the one that is kept to in the end, s.
    """

    def __init__(self, stop: threading.Event, shortest: float = 1.0, longest: float = 30.0) -> None:
        self._stop, self._shortest, self._longest = stop, shortest, longest
        self.seconds = shortest

    def reset(self) -> None:
        """Begin with the shortest wait again: an image came."""
        self.seconds = self._shortest

    def wait(self) -> None:
        """Wait, unless the process ends meanwhile."""
        self._stop.wait(self.seconds)
        self.seconds = min(2 * self.seconds, self._longest)
