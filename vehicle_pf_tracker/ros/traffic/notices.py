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

"""Sentences in the log, each kind of them at most every few seconds."""

from __future__ import annotations

import time
from collections.abc import Callable

_PERIOD = 5.0
"""Interval between two lines of the same kind, s."""


class Notices:
    """Writes a sentence unless one of its kind was written a moment ago.

    rclpy throttles by the line of code that logs, and so cannot tell kinds apart.

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
