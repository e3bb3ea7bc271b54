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

"""Control of a replay while it runs, its pace, and `/clock`.

Services and parameters are on the player's own node. They are named as those of the rosbag2 player,
with the types of std_srvs: rosbag2's own are not installed where rosbag2 is not. Speed and position
are parameters.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

RATE, POSITION = "rate", "position"
_FASTEST = 1e6
"""Highest rate: a million seconds a second paces nothing any more."""


class Controls:
    """State of the replay that the user controls.

    Parameters
    ----------
    node : Node
        The player's own node.
    rate : float
        Speed to begin with; 0 does not pace.
    length : float
        Length of the part that is played, in s.
    is_paused : bool
        True to begin paused.

    Attributes
    ----------
    is_paused : bool
        True while messages wait.
    steps : int
        Messages to publish although it is paused.
    rate : float
        Speed; 0 does not pace.
    target : float or None
        Position to continue from, in s; None to go on.
    changes : int
        Number of changes of any of these.
    """

    def __init__(self, node: Node, rate: float, length: float, *, is_paused: bool) -> None:
        self.is_paused, self.steps, self.rate = is_paused, 0, rate
        self.target: float | None = None
        self.changes = 0
        self._length = length
        self._position = 0.0
        answers: dict[str, Callable[[], tuple[bool, str]]] = {
            "pause": self._pause,
            "resume": self._resume,
            "toggle_paused": lambda: self._resume() if self.is_paused else self._pause(),
            "is_paused": lambda: (self.is_paused, self._words),
            "play_next": self._play_next,
        }
        for name, answer in answers.items():
            node.create_service(Trigger, f"~/{name}", _answering(answer))
        node.declare_parameter(
            RATE,
            rate,
            _described("Speed of the replay, 1.0 is as recorded, 0.0 not paced.", _FASTEST),
        )
        node.declare_parameter(
            POSITION, 0.0, _described("Set it to continue from there, in s from the begin.", length)
        )
        node.add_on_set_parameters_callback(self._take)

    def reach(self, position: float) -> None:
        """Note the position of the last message, in s."""
        self._position = position

    def watch(self) -> Callable[[], bool]:
        """Return a test whether anything has changed since now."""
        before = self.changes
        return lambda: self.changes != before

    def take_target(self) -> float | None:
        """Return the position to continue from, once."""
        target, self.target = self.target, None
        return target

    @property
    def _words(self) -> str:
        state = "paused" if self.is_paused else "playing"
        return f"{state} at {self._position:.3f} s of {self._length:.3f} s"

    def _pause(self) -> tuple[bool, str]:
        self.is_paused = True
        self.changes += 1
        return True, self._words

    def _resume(self) -> tuple[bool, str]:
        self.is_paused, self.steps = False, 0
        self.changes += 1
        return True, self._words

    def _play_next(self) -> tuple[bool, str]:
        if not self.is_paused:
            return False, "the replay is not paused"
        self.steps += 1
        self.changes += 1
        return True, self._words

    def _take(self, parameters: list[Parameter]) -> SetParametersResult:
        for one in parameters:  # rclpy has checked types and ranges
            if one.name == RATE:
                self.rate = one.value
            elif one.name == POSITION:
                self.target = one.value
        self.changes += 1
        return SetParametersResult(successful=True)


def _described(words: str, most: float) -> ParameterDescriptor:
    span = FloatingPointRange(from_value=0.0, to_value=most)
    return ParameterDescriptor(description=words, floating_point_range=[span])


def _answering(
    answer: Callable[[], tuple[bool, str]],
) -> Callable[[Trigger.Request, Trigger.Response], Trigger.Response]:
    def respond(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = answer()
        return response

    return respond


class Pace:
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

    def set_rate(self, rate: float | None) -> None:
        """Go on at another rate from the next log time."""
        self._rate = rate
        self.restart()

    def restart(self) -> None:
        """Take the next log time as now; a loop does this at each restart, a pause at its end."""
        self._begin = None

    def due(self, log_time_ns: int) -> float:
        """Moment on the clock, in s, at which a message with this log time is due."""
        now = self._clock()
        if self._begin is None:
            self._begin = log_time_ns, now
        self._latest_ns = log_time_ns
        if self._rate is None:
            return now
        first_ns, began = self._begin
        return began + (log_time_ns - first_ns) * 1e-9 / self._rate

    def log_time_ns(self) -> int | None:
        """Present log time, never beyond the message asked for last; None before the first.

        Without a rate, time advances with the messages.
        """
        if self._begin is None or self._rate is None:
            return self._latest_ns if self._begin else None
        first_ns, began = self._begin
        return min(first_ns + round((self._clock() - began) * self._rate * 1e9), self._latest_ns)


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
