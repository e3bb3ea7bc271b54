# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`/diagnostics` of a node: its health once a second, and why no images arrive."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from vehicle_pf_tracker.ros.messages import LEVELS, status
from vehicle_pf_tracker.ros.node.health import Health
from vehicle_pf_tracker.ros.node.image_input import ImageInput

_PERIOD = 1.0
"""Interval of the reports, s: that of ROS's own diagnostic_updater."""
SILENCE = 5.0
"""Time without an image after which a warning is published, s: a camera that connects again is
back within it, and nobody looks at a picture that stands for longer."""
_WARNING_PERIOD = 30.0
"""Interval between two lines in the log about one silence, s, a choice; /diagnostics has it each
time."""


class Diagnostics:
    """Publishes the node's health while it exists.

    Parameters
    ----------
    node : Node
        Node to report on.
    facts : callable
        Returns other values to publish, by name.

    Attributes
    ----------
    health : Health
        Counters since the node was configured.
    source : ImageInput or None
        The open subscription; None while the node is not active.
    """

    def __init__(self, node: Node, facts: Callable[[], Mapping[str, object]]) -> None:
        self._node = node
        self._facts = facts
        self.health = Health()
        self.source: ImageInput | None = None
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        # Steady, because simulated time may stand still and that is worth a report too.
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(_PERIOD, self.publish, clock=clock)

    def begin(self) -> Health:
        """Reset the counters, and return them."""
        self.health = Health()
        return self.health

    def listen_to(self, source: ImageInput) -> None:
        """Expect images from `source`."""
        self.source = source
        self.health.arrivals.listen()

    def cease(self) -> None:
        """Close the source and expect nothing."""
        if self.source is not None:
            self.source.close()
        self.source = None

    def publish(self) -> None:
        """Publish one report."""
        # Asked for each time, as publishers come and go without a callback.
        publishers = self.source.count_publishers() if self.source else 0
        values = {**self.health.report(), "matched publishers": publishers, **self._facts()}
        level, words = self._judge()
        # With its namespace, for who gathers the reports of several cameras.
        name = self._node.get_fully_qualified_name().lstrip("/")
        topic = self.source.topic if self.source else ""
        message = DiagnosticArray(status=[status(level, f"{name}: tracker", words, topic, values)])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _judge(self) -> tuple[bytes, str]:
        if self.source is None:
            return DiagnosticStatus.OK, "not active"
        topic = self.source.topic
        level = LEVELS[self.health.mode]
        if self.health.arrivals.silence < SILENCE:
            return level, self.health.mode
        words = f"no image for {SILENCE:g} s on {topic}: {self.source.explain_silence()}"
        self._node.get_logger().warning(words, throttle_duration_sec=_WARNING_PERIOD)
        # A worse level of the tracker itself is not hidden by the silence.
        return max(level, DiagnosticStatus.WARN), words
