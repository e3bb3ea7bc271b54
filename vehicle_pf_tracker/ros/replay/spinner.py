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

"""Waiting while callbacks run: for a condition, a time or an interruption."""

from __future__ import annotations

import time
from collections.abc import Callable
from threading import Event

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

_SLICE = 0.05
"""Longest uninterrupted wait in s: changes of the graph and signals wake no executor."""


class Interrupted(Exception):  # noqa: N818 (no error: the user wants it so)
    """The user asked the replay to end."""


class Spinner:
    """Runs the callbacks of one node while waiting.

    Parameters
    ----------
    node : Node
        The node; its context must outlive this object.
    stop : Event
        Once it is set, every wait ends with `Interrupted`.
    watch : callable
        Called during every wait; what it raises ends the wait.
    """

    def __init__(self, node: Node, stop: Event, watch: Callable[[], None] = lambda: None) -> None:
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._stop = stop
        self._watch = watch

    def check(self) -> None:
        """Raise `Interrupted` if the user asked to end, or what `watch` raises."""
        if self._stop.is_set():
            raise Interrupted
        self._watch()

    def until(self, holds: Callable[[], bool], timeout: float | None = None) -> bool:
        """Wait until `holds()`; False if it does not within `timeout` s (None: however long)."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not holds():
            self.check()
            left = _SLICE if deadline is None else deadline - time.monotonic()
            if left <= 0:
                return False
            self._executor.spin_once(timeout_sec=min(left, _SLICE))
        return True

    def until_time(self, moment: float, unless: Callable[[], bool] = lambda: False) -> None:
        """Wait until the monotonic clock shows `moment` s; one callback runs even if it is late.

        `unless` ends the wait early.
        """
        left = 0.0
        while left >= 0 and not unless():
            self.check()
            self._executor.spin_once(timeout_sec=min(max(left, 0.0), _SLICE))
            left = moment - time.monotonic()

    def close(self) -> None:
        """Release the node."""
        self._executor.shutdown()
