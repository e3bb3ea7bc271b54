"""The executor of the tracker nodes: while messages flow, it waits for little else.

For each callback, rclpy puts every entity of the node into a new wait set, and does it once more
afterwards: a managed node has over a dozen services and two dozen event handlers. That takes longer
than all that a tracker node does with an image besides tracking.
"""

from __future__ import annotations

import time
from typing import Any

from rclpy.context import Context
from rclpy.executors import ShutdownException, SingleThreadedExecutor, TimeoutException
from rclpy.subscription import Subscription
from rclpy.timer import Timer

LOOK_EVERY = 0.1
"""Longest time in s that a service or an event waits while messages flow."""

_ALWAYS = (Subscription, Timer)


class ImageExecutor(SingleThreadedExecutor):  # type: ignore[misc]
    """A single thread that waits for messages and timers alone while messages keep coming.

    Every `LOOK_EVERY` s it serves whatever else is ready. When no message came for so long, it
    waits for everything, as its base class always does.

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

    def can_execute(self, entity: Any) -> bool:
        """Tell whether `entity` is to be waited for now."""
        if self._flowing and not self._looking and not isinstance(entity, _ALWAYS):
            return False
        return bool(super().can_execute(entity))

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for one callback and run it; without a timeout it may return without one."""
        if timeout_sec is not None or not self._flowing:
            self._flowing = isinstance(self._run_one(timeout_sec), Subscription)
            self._look_at = time.monotonic() + LOOK_EVERY
            return
        self._looking = self._looking or time.monotonic() >= self._look_at
        if not self._looking:
            self._flowing = self._run_one(LOOK_EVERY) is not None
        elif self._run_one(0.0) is None:  # all that was ready has been served
            self._looking = False
            self._look_at = time.monotonic() + LOOK_EVERY

    def _run_one(self, timeout_sec: float | None) -> Any | None:
        """Run one callback, and return whose it was; None if none was ready in time."""
        try:
            task, entity, _ = self.wait_for_ready_callbacks(timeout_sec)
        except (ShutdownException, TimeoutException):
            return None
        task()
        if task.exception() is not None:
            raise task.exception()
        return entity
