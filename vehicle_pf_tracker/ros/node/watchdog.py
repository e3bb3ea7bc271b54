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

"""A watch over the steps of a node: one that takes too long is reported with where it is."""

from __future__ import annotations

import sys
import threading
import time
import traceback
import weakref
from collections.abc import Callable

_LOOK_EVERY = 0.1
"""Seconds between two looks at the step: a fifth of the least patience."""


class Watchdog:
    """Looks at the steps of the thread that makes it, from a thread of its own.

    `faulthandler` would look without Python's lock: it has read frames while they changed, and
    ended a node with a segmentation fault.

    Parameters
    ----------
    say : callable
        Takes the report; called in the watching thread.
    """

    def __init__(self, say: Callable[[str], object]) -> None:
        self._say = say
        self._watched = threading.get_ident()
        self._deadline: tuple[float, float] | None = None
        # It holds no reference to the watchdog between two looks, and so ends after it.
        threading.Thread(target=_watch, args=[weakref.ref(self)], daemon=True).start()

    def begin(self, patience: float) -> None:
        """Begin a step that should take `patience` s at most."""
        self._deadline = time.monotonic() + patience, patience

    def end(self) -> None:
        """End the step."""
        self._deadline = None

    def look(self) -> None:
        """Report a step that takes longer, once."""
        deadline = self._deadline
        frame = sys._current_frames().get(self._watched)
        # Compared last: a step that ended meanwhile is not reported with the next one's frames.
        if deadline is None or frame is None or time.monotonic() < deadline[0]:
            return
        if self._deadline is deadline:
            self._deadline = None
            place = "".join(traceback.format_stack(frame))
            self._say(f"an image takes longer than {deadline[1]:.1f} s; it is at\n{place}")


def _watch(watchdog: weakref.ref[Watchdog]) -> None:
    while True:
        time.sleep(_LOOK_EVERY)
        if (present := watchdog()) is None:
            return
        present.look()
        del present
