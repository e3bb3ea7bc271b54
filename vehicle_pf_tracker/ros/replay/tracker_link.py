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

"""The player's side of one tracker node: its answers, its target and its reset.

Images that a node has answered, and its answers.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_srvs.srv import Trigger

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.offline.estimates import EstimateRow
from vehicle_pf_tracker.ros.messages import NOT_READY
from vehicle_pf_tracker.ros.replay.discovery import DISCOVERY, Spinner
from vehicle_pf_tracker.trackers.localisation import ROAD_COLUMNS

DROPPED = "DROPPED"
"""Mode of a frame that a node never answered; all numbers are empty."""


class Answers:
    """Pairs the `~/mode` messages of one node with the images published, by stamp.

    Images of the same stamp are answered in the order in which they were published.

    Attributes
    ----------
    count : int
        Images answered, in all passes.
    """

    def __init__(self) -> None:
        self.count = 0
        self._stamps: dict[int, int] = {}
        self._waiting: dict[int, deque[int]] = {}
        self._rows: dict[int, EstimateRow] = {}
        self._on_road: dict[int, Mapping[str, str]] = {}

    def begin_pass(self) -> None:
        """Discard earlier frames; a loop begins again with their stamps."""
        self._stamps.clear()
        self._waiting.clear()
        self._rows.clear()
        self._on_road.clear()

    def expect(self, frame: int, stamp_ns: int) -> None:
        """Note that the image number `frame` was published."""
        self._stamps[frame] = stamp_ns
        self._waiting.setdefault(stamp_ns, deque()).append(frame)

    def receive(self, message: Any) -> None:
        """Take a `DiagnosticArray` of `~/mode`; answers to other images are passed over."""
        stamp = message.header.stamp
        stamp_ns = stamp.sec * 1_000_000_000 + stamp.nanosec
        frames = self._waiting.get(stamp_ns)
        if not frames or not message.status:
            return
        frame = frames.popleft()
        if not frames:
            del self._waiting[stamp_ns]
        status = message.status[0]
        scalars = {"mode": status.message, **{pair.key: pair.value for pair in status.values}}
        self._rows[frame] = EstimateRow.from_scalars(frame, stamp_ns, scalars)
        if "road" in scalars:
            self._on_road[frame] = scalars
        self.count += 1

    def has(self, frame: int) -> bool:
        """Return whether image number `frame` of this pass was answered."""
        return frame in self._rows

    def road_columns(self) -> dict[str, list[float | None]]:
        """Return places and speeds on the road, a value for each of `rows`; none without a road."""
        if not self._on_road:
            return {}
        answers = [self._on_road.get(frame, {}) for frame in self._stamps]
        return {
            name: [float(one[name]) if name in one else None for one in answers]
            for name in ROAD_COLUMNS
        }

    def rows(self) -> tuple[EstimateRow, ...]:
        """One row for each image of this pass, in order."""
        return tuple(
            self._rows.get(frame) or EstimateRow.without(frame, stamp_ns, DROPPED)
            for frame, stamp_ns in self._stamps.items()
        )


_DEEP = QoSProfile(depth=1000)
_AGAIN = 0.2
"""Seconds until a node that is not ready is asked again."""


class TrackerLink:
    """Talks to the tracker node `name`.

    Make the links after the publishers of the images. A participant tells others about its
    endpoints in the order in which it made them, so that a node which answers a service call
    (`greet`) already knows the image publishers and the subscription to its `~/mode`, and neither
    the first image nor its answer can be lost.

    Parameters
    ----------
    node : Node
        The player's own node.
    spinner : Spinner
        Runs the callbacks while waiting.
    name : str
        Full name of the tracker node.
    timeout : float
        Longest wait for one answer of a service in s, if longer than `DISCOVERY`.
    """

    def __init__(self, node: Node, spinner: Spinner, name: str, timeout: float) -> None:
        self.name = name
        self.answers = Answers()
        self._spinner = spinner
        self._timeout = max(timeout, DISCOVERY)
        self._mode = node.create_subscription(
            DiagnosticArray, f"{name}/mode", self.answers.receive, _DEEP
        )
        self._get = node.create_client(GetParameters, f"{name}/get_parameters")
        self._set = node.create_client(SetParametersAtomically, f"{name}/set_parameters_atomically")
        self._reset = node.create_client(Trigger, f"{name}/reset")

    def greet(self) -> None:
        """Wait until the node and the player know all of each other's endpoints.

        Raises
        ------
        InputError
            If that takes longer than the timeout.
        """
        if not self._spinner.until(self._is_matched, self._timeout):
            raise InputError(
                f"the node {self.name} did not offer {self.name}/mode within {self._timeout:g} s; "
                "is it an active tracker node?"
            )
        self._call(self._get, GetParameters.Request())

    def set_target(self, box: Box | None, *, may_reset: bool = False) -> None:
        """Set the node's configured target; None makes it wait for one after the next reset.

        Parameters
        ----------
        box : Box or None
            The target.
        may_reset : bool
            Whether to reset the node and try again if it refuses.

        Raises
        ------
        InputError
            If the node refuses it or does not answer.
        """
        values = (box.x, box.y, box.width, box.height) if box else (0.0, 0.0, 0.0, 0.0)
        names = ("target.x", "target.y", "target.width", "target.height")
        request = SetParametersAtomically.Request(
            parameters=_doubles(dict(zip(names, values, strict=True)))
        )
        result = self._call(self._set, request).result
        if not result.successful and may_reset:
            # It may be outside of the images that the node has seen before, of another size.
            self._call(self._reset, Trigger.Request())
            result = self._call(self._set, request).result
        if not result.successful:
            raise InputError(f"the node {self.name} refuses the target {box}: {result.reason}")

    def reset(self) -> None:
        """Send the node back to its configured target.

        Raises
        ------
        InputError
            If the node refuses or does not answer.
        """
        result = self._call(self._reset, Trigger.Request())
        while not result.success and result.message.startswith(NOT_READY):
            # However long that takes: the node lives, or its service would not have answered.
            self._spinner.until_time(time.monotonic() + _AGAIN)
            result = self._call(self._reset, Trigger.Request())
        if not result.success:
            raise InputError(f"the node {self.name} refuses to reset: {result.message}")

    def _is_matched(self) -> bool:
        return bool(self._mode.get_publisher_count())

    def _call(self, client: Any, request: Any) -> Any:
        if not self._spinner.until(client.service_is_ready, self._timeout):
            raise InputError(
                f"the service {client.srv_name} is not there after {self._timeout:g} s; "
                f"is {self.name} an active tracker node?"
            )
        future = client.call_async(request)
        if not self._spinner.until(future.done, self._timeout):
            raise InputError(f"no answer from {client.srv_name} within {self._timeout:g} s")
        return future.result()


def _doubles(values: Mapping[str, float]) -> list[Parameter]:
    return [
        Parameter(
            name=name,
            value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=float(value)),
        )
        for name, value in values.items()
    ]
