# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The pace of a replay: log time against real time, and `/clock` that follows it."""

from __future__ import annotations

import time
from collections.abc import Callable

from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.node import Node
from rosgraph_msgs.msg import Clock


class ReplayPace:
    """Maps log times to the monotonic clock.

    Parameters
    ----------
    rate : float or None
        Seconds of log time per second; None does not pace: everything is due at once.
    clock : callable
        The monotonic clock in s.
    """

    def __init__(self, rate: float | None, clock: Callable[[], float] = time.monotonic) -> None:
        self._rate = rate
        self._clock = clock
        self._begin: tuple[int, float] | None = None
        self._latest_ns = 0
        self._paused_at: float | None = None
        self._paused_for = 0.0

    @property
    def is_paused(self) -> bool:
        """True while nothing is to be published."""
        return self._paused_at is not None

    def set_paused(self, paused: bool) -> None:
        """Let log time stand still, or go on from where it stood."""
        now = self._clock()
        if self._paused_at is not None:
            self._paused_for += now - self._paused_at
        self._paused_at = now if paused else None

    def _now(self) -> float:
        """Return the clock less all pauses, s."""
        at = self._clock() if self._paused_at is None else self._paused_at
        return at - self._paused_for

    def restart(self) -> None:
        """Take the next log time as now, as each pass of a loop does."""
        self._begin = None

    def due(self, log_time_ns: int) -> float:
        """Moment on the clock, in s, at which a message with this log time is due."""
        if self._begin is None:
            self._begin = log_time_ns, self._now()
        self._latest_ns = log_time_ns
        if self._rate is None:
            return self._clock()
        first_ns, began = self._begin
        return self._paused_for + began + (log_time_ns - first_ns) * 1e-9 / self._rate

    def log_time_ns(self) -> int | None:
        """Present log time, never beyond the message asked for last; None before the first.

        Without a rate, time advances with the messages.
        """
        if self._begin is None or self._rate is None:
            return self._latest_ns if self._begin else None
        first_ns, began = self._begin
        return min(first_ns + round((self._now() - began) * self._rate * 1e9), self._latest_ns)


class PlaybackClock:
    """Publishes the log time that it is by `pace`, from the first message on.

    Parameters
    ----------
    node : Node
        The player's own node.
    pace : ReplayPace
        Tells the log time.
    frequency : float
        Messages per second.
    """

    def __init__(self, node: Node, pace: ReplayPace, frequency: float) -> None:
        self._pace = pace
        self._publisher = node.create_publisher(Clock, "/clock", 10)
        steady = RosClock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(1 / frequency, self.publish, clock=steady)

    def publish(self) -> None:
        """Publish the time now."""
        log_time_ns = self._pace.log_time_ns()
        if log_time_ns is None:
            return
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(log_time_ns, 1_000_000_000)
        self._publisher.publish(message)
