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

"""The executor of the tracker nodes: while messages flow, it waits for little else.

For each callback, rclpy puts every entity of the node into a new wait set, and then into another,
since a callback wakes its executor: a managed node has over a dozen services and two dozen event
handlers. That takes longer than all that a tracker node does with an image besides tracking. Event
handlers cost most, and can wait; requests cannot.
"""

from __future__ import annotations

import time

from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription

from vehicle_pf_tracker.ros.rclpy_internals import (
    DirectExecutor,
    MessageSources,
    can_run_directly,
)

LOOK_EVERY = 0.2
"""Longest time in s that an event waits while messages flow."""


def node_executor() -> Executor:
    """Make the executor of a node's process: `ImageExecutor` where this rclpy allows it."""
    return ImageExecutor() if can_run_directly() else SingleThreadedExecutor()


class ImageExecutor(DirectExecutor):
    """A single thread that waits for messages, timers and requests alone while images flow.

    Every `LOOK_EVERY` s it serves whatever else is ready. When no message came for so long, it
    waits for everything, as its base class always does. The callbacks of subscriptions and services
    have to be plain functions, no coroutines.

    Parameters
    ----------
    context : Context, optional
        The default one unless given.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._flowing = False
        self._looking = False
        self._look_at = 0.0
        self._sources: dict[Node, MessageSources] = {}

    def add_node(self, node: Node) -> bool:
        """Add a node whose callbacks are to be run."""
        self._sources[node] = MessageSources(node)
        return bool(super().add_node(node))

    def remove_node(self, node: Node) -> None:
        """Run no more callbacks of a node."""
        self._sources.pop(node, None)
        super().remove_node(node)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for one callback and run it; without a timeout it may return without one."""
        if timeout_sec is not None or not self._flowing:
            self._flowing = isinstance(self.run_one(timeout_sec), Subscription)
            self._look_at = time.monotonic() + LOOK_EVERY
            return
        self._looking = self._looking or time.monotonic() >= self._look_at
        if not self._looking:
            self._flowing = self.run_one(LOOK_EVERY, list(self._sources.values())) is not None
        elif self.run_one(0.0) is None:  # all that was ready has been served
            self._looking = False
            self._look_at = time.monotonic() + LOOK_EVERY
