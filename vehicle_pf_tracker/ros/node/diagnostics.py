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

"""`/diagnostics` at 1 Hz: the node's health, and why no images arrive."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from vehicle_pf_tracker.ros.messages import LEVELS, key_values
from vehicle_pf_tracker.ros.node.health import Health
from vehicle_pf_tracker.ros.node.image_input import ImageInput

PERIOD = 1.0
SILENCE = 5.0
"""Time without an image after which a warning is published, s."""

_WARNING_PERIOD = 30.0


class Diagnostics:
    """Publishes the node's health while it exists.

    Parameters
    ----------
    node : Node
        Whose health it is.

    Attributes
    ----------
    health : Health
        Counters since the node was configured.
    source : ImageInput or None
        The open subscription; None while the node is not active.
    facts : dict
        What else to publish, by name.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.health = Health()
        self.source: ImageInput | None = None
        self.facts: dict[str, object] = {}
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        # Steady, because simulated time may stand still and that is worth a report too.
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(PERIOD, self.publish, clock=clock)

    def begin(self) -> Health:
        """Reset the counters, and return them."""
        self.health = Health()
        return self.health

    def listen_to(self, source: ImageInput) -> None:
        """Expect images from `source`."""
        self.source = source
        self.health.listen()

    def cease(self) -> None:
        """Close the source and expect nothing."""
        if self.source is not None:
            self.source.close()
        self.source = None

    def arrived(self, info: Mapping[str, Any], age: float) -> None:
        """Count an image; see `Health.arrived`."""
        if self.source is not None:
            self.health.arrived(info, age, self.source.publisher_count)

    def publish(self) -> None:
        """Publish one report."""
        level, words = self._judge()
        publishers = self.source.publisher_count if self.source else 0
        values = {**self.health.report(), "matched publishers": publishers, **self.facts}
        status = DiagnosticStatus(
            level=level,
            name=f"{self._node.get_name()}: tracker",
            message=words,
            hardware_id=self.source.topic if self.source else "",
            values=key_values(values),
        )
        message = DiagnosticArray(status=[status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _judge(self) -> tuple[bytes, str]:
        if self.source is None:
            return DiagnosticStatus.OK, "not active"
        if self.health.silence < SILENCE:
            return LEVELS[self.health.mode], self.health.mode
        words = (
            f"no image for {SILENCE:g} s on {self.source.topic}: {self.source.explain_silence()}"
        )
        self._node.get_logger().warning(words, throttle_duration_sec=_WARNING_PERIOD)
        return DiagnosticStatus.WARN, words
