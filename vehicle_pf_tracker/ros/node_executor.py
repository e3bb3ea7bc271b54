# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The executor of a process of nodes: while messages flow, it waits for little else.

For each callback, rclpy's own puts every entity of all nodes into a new wait set, and then into
another, since its task wakes the executor: a managed node has over a dozen services and two dozen
event handlers. That costs more than all that a node does with an image besides tracking, and a
process of several nodes pays for those of all with each image.

rclpy's executor of events costs as little, but its 7.1.6 fails on callbacks that take a message's
info (SystemError), from which dropped images are counted; and without a time-out it returns at
once, as its wheel's C++ library lets the end of time overflow.
"""

from __future__ import annotations

import time

from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node

from vehicle_pf_tracker.ros.rclpy_internals import (
    EntityWait,
    InvalidHandle,
    ReadyEntities,
    can_wait_for_entities,
    run_callback,
    run_timer,
)

LOOK_EVERY = 1.0
"""Longest time in s that an event waits while messages flow: events are told to people alone, and
`/diagnostics` comes as seldom. To wait for everything costs as much as an image does; once a second
instead of twice takes a 25th off a node of 30 images/s."""
SILENT_AFTER = 0.5
"""Time in s without a message after which it waits for everything; as long a signal may wait, and
as long requests are looked for with each message once one came."""
REQUESTS_EVERY = 0.1
"""Longest time in s that a first request waits while messages flow: not felt by who asks. A node
has 13 services, and to wait for those of eight nodes costs more than to wait for their images."""


def node_executor() -> Executor:
    """Make the executor of a process: `MessageExecutor` where this rclpy allows it."""
    return MessageExecutor() if can_wait_for_entities() else SingleThreadedExecutor()


class MessageExecutor(SingleThreadedExecutor):  # type: ignore[misc]
    """A single thread that waits for messages and timers alone while messages flow.

    Requests are looked for every `REQUESTS_EVERY` s, and with each message once one came. Every
    `LOOK_EVERY` s, and after `SILENT_AFTER` s of silence, it waits for everything, as its base
    does. The callbacks of subscriptions and timers have to be plain functions, no coroutines.

    Parameters
    ----------
    context : Context, optional
        The default one unless given.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        # Before the base, which may call `wake`.
        self._wait: EntityWait | None = None
        self._has_changed = True
        super().__init__(context=context)
        self._is_flowing = False
        self._look_at = 0.0
        self._requests_at = 0.0
        self._asked_until = 0.0

    def wake(self) -> None:
        """Note that entities were made or destroyed, as nodes say by it, from any thread."""
        self._has_changed = True
        super().wake()

    def add_node(self, node: Node) -> bool:
        """Run the callbacks of a node."""
        self._has_changed = True
        return bool(super().add_node(node))

    def remove_node(self, node: Node) -> None:
        """Leave the callbacks of a node to others."""
        self._has_changed = True
        super().remove_node(node)

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
        for_requests = now >= self._requests_at
        ready = self._run_ready(for_requests=for_requests)
        if ready.has_requests:
            self._asked_until = now + SILENT_AFTER
        is_silent = not any(ready)
        if for_requests:
            self._is_flowing = not is_silent
            if now >= self._asked_until:
                self._requests_at = now + REQUESTS_EVERY
        elif is_silent:
            self._requests_at = now

    def _run_ready(self, *, for_requests: bool) -> ReadyEntities:
        """Wait, and run what is ready: messages and timers, and one request."""
        longest = SILENT_AFTER if for_requests else REQUESTS_EVERY
        ready = self._ready(longest, for_requests=for_requests)
        for subscription in ready.subscriptions:
            run_callback(subscription)
        for timer in ready.timers:
            run_timer(timer)
        if ready.has_requests:
            # One at a time: images wait for it no longer than for rclpy's own executor.
            super().spin_once(0.0)
        return ready

    def _ready(self, seconds: float, *, for_requests: bool) -> ReadyEntities:
        try:
            if self._wait is None or self._has_changed:
                # Before they are listed: what changes meanwhile is listed the next time.
                self._has_changed = False
                self._wait = EntityWait(self.context, self.get_nodes())
            return self._wait.wait(seconds, for_requests=for_requests)
        except InvalidHandle:  # another thread has destroyed one, and says so after that
            self._has_changed = True
            return ReadyEntities([], [], has_requests=False)
