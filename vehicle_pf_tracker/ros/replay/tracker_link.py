# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The player's link to one tracker node: its answers, its target and its reset."""

from __future__ import annotations

import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.messages import NOT_READY
from vehicle_pf_tracker.ros.replay.answers import Answers
from vehicle_pf_tracker.ros.replay.discovery import SHORTEST_SEARCH, Spinner
from vehicle_pf_tracker.ros.replay.replay_report import NodeReport

_DEPTH = 1000
"""Answers that may wait: half a minute of 30 Hz, while the player reads a slow disk."""
_AGAIN = 0.2
"""Seconds until a node that is not ready is asked again: it compiles for up to a minute, so a
fifth of a second is not missed, and the questions cost it nothing."""


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
        Longest wait for one answer of a service in s, if longer than `SHORTEST_SEARCH`.
    """

    def __init__(self, node: Node, spinner: Spinner, name: str, timeout: float) -> None:
        self.name = name
        self.answers = Answers()
        self._spinner = spinner
        self._timeout = max(timeout, SHORTEST_SEARCH)
        self._mode = node.create_subscription(
            DiagnosticArray, f"{name}/mode", self.answers.receive, _DEPTH
        )
        self._get = node.create_client(GetParameters, f"{name}/get_parameters")
        self._set = node.create_client(SetParametersAtomically, f"{name}/set_parameters_atomically")
        self._reset = node.create_client(Trigger, f"{name}/reset")

    def report(self) -> NodeReport:
        """Return what the node has answered."""
        answers = self.answers
        return NodeReport(self.name, answers.count, answers.rows(), answers.road_columns())

    def greet(self) -> None:
        """Wait until the node and the player know all of each other's endpoints.

        Raises
        ------
        InputError
            If that takes longer than the timeout.
        """
        if not self._spinner.until(lambda: self._mode.get_publisher_count() > 0, self._timeout):
            raise InputError(
                f"the node {self.name} did not offer {self.name}/mode within {self._timeout:g} s; "
                "is it an active tracker node?"
            )
        self._call(self._get, GetParameters.Request())

    def await_answer(self, frame: int, timeout: float) -> bool:
        """Wait until image number `frame` is answered, for `timeout` s after any other answer."""
        answers = self.answers
        count = -1

        def goes_on() -> bool:
            return answers.count > count

        while not answers.has(frame) and goes_on():
            count = answers.count
            self._spinner.until(goes_on, timeout)
        return answers.has(frame)

    def set_target(self, box: Box | None, *, may_reset: bool = False) -> None:
        """Set the node's configured target; None makes it wait for one after the next reset.

        Parameters
        ----------
        box : Box or None
            The target.
        may_reset : bool
            True to reset the node and try again if it refuses.

        Raises
        ------
        InputError
            If the node refuses it or does not answer.
        """
        values = (box.x, box.y, box.width, box.height) if box else (0.0, 0.0, 0.0, 0.0)
        names = ("target.x", "target.y", "target.width", "target.height")
        request = SetParametersAtomically.Request(
            parameters=[
                Parameter(name, Parameter.Type.DOUBLE, float(value)).to_parameter_msg()
                for name, value in zip(names, values, strict=True)
            ]
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
