"""The executor of the tracker nodes: while messages flow, it waits for little else.

For each callback, rclpy puts every entity of the node into a new wait set, and then into another,
since a callback wakes its executor: a managed node has over a dozen services and two dozen event
handlers. That takes longer than all that a tracker node does with an image besides tracking.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from rclpy.context import Context
from rclpy.executors import ShutdownException, SingleThreadedExecutor, TimeoutException
from rclpy.node import Node
from rclpy.subscription import Subscription
from rclpy.task import Task
from rclpy.timer import Timer

LOOK_EVERY = 0.2
"""Longest time in s that a service or an event waits while messages flow."""


class _Messages:
    """What a node has of subscriptions and timers, as a node that has nothing else.

    Looking through the node's other entities for each image would take longer than waiting.
    """

    clients = services = guards = waitables = ()

    def __init__(self, node: Node) -> None:
        self._node = node

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """Those that there are now."""
        found: Iterator[Subscription] = self._node.subscriptions
        return found

    @property
    def timers(self) -> Iterator[Timer]:
        """Those that there are now."""
        found: Iterator[Timer] = self._node.timers
        return found


class ImageExecutor(SingleThreadedExecutor):  # type: ignore[misc]
    """A single thread that waits for messages and timers alone while messages keep coming.

    Every `LOOK_EVERY` s it serves whatever else is ready. When no message came for so long, it
    waits for everything, as its base class always does. The callbacks of subscriptions have to be
    plain functions, no coroutines.

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
        self._messages: dict[Node, _Messages] = {}

    def add_node(self, node: Node) -> bool:
        """Add a node whose callbacks are to be run."""
        self._messages[node] = _Messages(node)
        return bool(super().add_node(node))

    def remove_node(self, node: Node) -> None:
        """Run no more callbacks of a node."""
        self._messages.pop(node, None)
        super().remove_node(node)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for one callback and run it; without a timeout it may return without one."""
        if timeout_sec is not None or not self._flowing:
            self._flowing = isinstance(self._run_one(timeout_sec), Subscription)
            self._look_at = time.monotonic() + LOOK_EVERY
            return
        self._looking = self._looking or time.monotonic() >= self._look_at
        if not self._looking:
            self._flowing = self._run_one(LOOK_EVERY, list(self._messages.values())) is not None
        elif self._run_one(0.0) is None:  # all that was ready has been served
            self._looking = False
            self._look_at = time.monotonic() + LOOK_EVERY

    def _run_one(
        self, timeout_sec: float | None, nodes: Sequence[_Messages] | None = None
    ) -> Any | None:
        """Run one callback, and return whose it was; None if none was ready in time."""
        try:
            task, entity, _ = self.wait_for_ready_callbacks(timeout_sec, nodes)
        except (ShutdownException, TimeoutException):
            return None
        task()
        if isinstance(task, Task) and task.exception() is not None:
            raise task.exception()
        return entity

    def _make_handler(self, entity: Any, node: Node, take: Callable[[Any], Any]) -> Any:
        # rclpy's task triggers the executor's guard condition, for other threads that there are
        # none of here, and the next wait ends at once for it.
        if not isinstance(entity, Subscription):
            return super()._make_handler(entity, node, take)
        entity._executor_event = True
        return lambda: _handle(entity, take)


def _handle(subscription: Subscription, take: Callable[[Any], Any]) -> None:
    """Take a message and run its callback."""
    subscription._executor_event = False
    if not subscription.callback_group.beginning_execution(subscription):
        return
    try:
        execute = take(subscription)
        if execute is not None:
            with contextlib.suppress(StopIteration):  # how a coroutine that never waits ends
                execute().send(None)
    finally:
        subscription.callback_group.ending_execution(subscription)
