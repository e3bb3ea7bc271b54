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

"""`/clock`: the time of the recording while it plays."""

from __future__ import annotations

from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from vehicle_pf_tracker.ros.replay.pacing import Pace


class PlaybackClock:
    """Publishes the log time that it is by `pace`, from the first message on.

    Parameters
    ----------
    node : Node
        The player's own node.
    pace : Pace
        Tells the log time.
    frequency : float
        Messages per second.
    """

    def __init__(self, node: Node, pace: Pace, frequency: float) -> None:
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
