# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The executor of a process of nodes: while messages flow, it waits for little else.

For each callback, rclpy's own puts every entity of all nodes into a new wait set, and then into
another, since its task wakes the executor: a managed node has over a dozen services and two dozen
event handlers. That costs more than all that a node does with an image besides tracking.

rclpy's executor of events costs as little, but its 7.1.6 fails on callbacks that take a message's
info (SystemError), from which dropped images are counted; and without a time-out it returns at
once, as its wheel's C++ library lets the end of time overflow.
"""

from __future__ import annotations

import time

from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor

from vehicle_pf_tracker.ros.rclpy_internals import EntityWait, can_wait_for_entities, run_callback

LOOK_EVERY = 0.5
"""Longest time in s that an event, or the end of the process, waits while messages flow. To wait
for everything costs about half a millisecond, of which one image more or less is not seen."""


def node_executor() -> Executor:
    """Make the executor of a process: `MessageExecutor` where this rclpy allows it."""
    return MessageExecutor() if can_wait_for_entities() else SingleThreadedExecutor()


class MessageExecutor(SingleThreadedExecutor):  # type: ignore[misc]
    """A single thread that waits for messages, timers and requests alone while messages flow.

    Every `LOOK_EVERY` s, and after a silence as long, it waits for everything, as its base does.
    The callbacks of subscriptions have to be plain functions, no coroutines.

    Parameters
    ----------
    context : Context, optional
        The default one unless given.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._wait = EntityWait(self.context)
        self._is_flowing = False
        self._look_at = 0.0

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for callbacks and run them; without a timeout it may return without any."""
        now = time.monotonic()
        if timeout_sec is not None or not self._is_flowing:
            super().spin_once(timeout_sec)
            self._is_flowing = True
            self._look_at = now + LOOK_EVERY
            return
        if now >= self._look_at:
            self._look_at = now + LOOK_EVERY
            super().spin_once(0.0)
        messages, has_others = self._wait.wait(self.get_nodes(), LOOK_EVERY)
        for subscription in messages:
            run_callback(subscription)
        if has_others:  # one at a time: images wait for it no longer than for rclpy's own executor
            super().spin_once(0.0)
        self._is_flowing = bool(messages) or has_others
