# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The player's side of the tracker nodes: their answers, their target and their reset."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.clock import MAX_DIFF, is_nearest, max_diff_ns
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.driver import with_next
from vehicle_pf_tracker.recordings.reader import RecordedMessage, Recording
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.ros.messages import NOT_READY, stamp_ns
from vehicle_pf_tracker.ros.replay.discovery import DISCOVERY, Spinner
from vehicle_pf_tracker.ros.replay.replay_options import NodeReport, ReplayOptions
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
        self._waiting: dict[int, deque[int]] = {}
        self._rows: dict[int, EstimateRow] = {}
        self._answers: dict[int, Mapping[str, str]] = {}

    def begin_pass(self) -> None:
        """Discard earlier frames; a loop begins again with their stamps."""
        for kept in (self._waiting, self._rows, self._answers):
            kept.clear()

    def expect(self, frame: int, stamp_ns: int) -> None:
        """Note that the image number `frame` was published."""
        self._rows[frame] = EstimateRow.without(frame, stamp_ns, DROPPED)
        self._waiting.setdefault(stamp_ns, deque()).append(frame)

    def receive(self, message: Any) -> None:
        """Take a `DiagnosticArray` of `~/mode`; answers to other images are passed over."""
        stamp = stamp_ns(message.header)
        frames = self._waiting.get(stamp)
        if not frames or not message.status:
            return
        frame = frames.popleft()
        if not frames:
            del self._waiting[stamp]
        status = message.status[0]
        scalars = {"mode": status.message, **{pair.key: pair.value for pair in status.values}}
        self._rows[frame] = EstimateRow.from_scalars(frame, stamp, scalars)
        # All of a day would be gigabytes.
        self._answers[frame] = scalars if "road" in scalars else {}
        self.count += 1

    def has(self, frame: int) -> bool:
        """Return whether image number `frame` of this pass was answered."""
        return frame in self._answers

    def road_columns(self) -> dict[str, list[float | None]]:
        """Return places and speeds on the road, a value for each of `rows`; none without a road."""
        answers = [self._answers.get(frame, {}) for frame in self._rows]
        if not any(answers):
            return {}
        return {
            name: [float(one[name]) if name in one else None for one in answers]
            for name in ROAD_COLUMNS
        }

    def rows(self) -> tuple[EstimateRow, ...]:
        """One row for each image of this pass, in order."""
        return tuple(self._rows.values())


_DEPTH = 1000
"""Answers that may wait."""
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
        answers, count = self.answers, -1

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


def played(
    recording: Recording, options: ReplayOptions, topics: set[str]
) -> Iterator[RecordedMessage]:
    """Read the messages of `topics` in the part that is played."""
    return recording.messages(topics, options.start_offset, options.playback_duration)


def starting_target(recording: Recording, options: ReplayOptions) -> tuple[Box, int] | None:
    """Choose the target: the one given, else the first true box of the part that is played.

    A true box is started on in the image nearest to it in time, as offline.

    Returns
    -------
    (Box, int) or None
        The box, and the image to start in, counted from 1 in the part played; None without a
        target and truth.

    Raises
    ------
    InputError
        If no image is near the truth.
    """
    if options.target is not None:
        return options.target, 1
    earliest_ns = (first_image(recording, options).stamp_ns or 0) - max_diff_ns(MAX_DIFF)
    truth = recording.first_truth()
    if truth is not None and truth.stamp_ns < earliest_ns:
        truth = next((item for item in recording.truth() if item.stamp_ns >= earliest_ns), None)
    if truth is None:
        return None
    images = played(recording, options, {recording.image_topic})
    stamps = (image.stamp_ns for image in images if image.stamp_ns is not None)
    frame = nearest_frame(stamps, truth.stamp_ns, max_diff_ns(MAX_DIFF))
    if frame is None:
        raise InputError(
            f"no image that is played is within {MAX_DIFF:g} s of the first truth, "
            f"at {truth.stamp_ns / 1e9:.3f} s; give a target with --target x,y,w,h"
        )
    return truth.box, frame


def nearest_frame(stamps: Iterable[int], stamp_ns: int, limit_ns: int) -> int | None:
    """Count the frames from 1 up to the first that is nearer to `stamp_ns` than the next.

    Reads no further than one stamp beyond it; None if it is more than `limit_ns` away.
    """
    numbered = enumerate(with_next(stamps), start=1)
    return next((n for n, pair in numbered if is_nearest(*pair, stamp_ns, limit_ns)), None)


def first_image(recording: Recording, options: ReplayOptions) -> RecordedMessage:
    """Read the first image of the part that is played.

    Raises
    ------
    InputError
        If there is none in it.
    """
    first = next(played(recording, options, {recording.image_topic}), None)
    if first is None:
        length = (recording.end_ns - recording.start_ns) * 1e-9
        raise InputError(
            f"no image is in the part of {recording.path} that --start-offset and "
            f"--playback-duration choose; it lasts {length:.1f} s"
        )
    return first


class Targets:
    """Sets the nodes on `target` through their parameters.

    A service call ends when the node has accepted the target, so that it cannot overtake an image,
    or be overtaken by one, as a message could.

    Parameters
    ----------
    links : sequence of TrackerLink
        The nodes.
    target : (Box, int) or None
        As `starting_target` returns it; None leaves the nodes alone.
    """

    def __init__(self, links: Sequence[TrackerLink], target: tuple[Box, int] | None) -> None:
        self._links = links
        self._target = target
        self._is_first_pass = True

    def begin_pass(self) -> None:
        """Reset the nodes onto the target, or to waiting if it is known only later.

        In later passes of a loop the stamps go back, which the nodes notice by themselves.
        """
        if self._target is None:
            return
        box, frame = self._target
        if frame > 1 or self._is_first_pass:
            for link in self._links:
                link.set_target(box if frame == 1 else None, may_reset=True)
            for link in self._links:
                link.reset()
        self._is_first_pass = False

    def before(self, frame: int) -> None:
        """Set the target right before the image number `frame` if it is the one to start in."""
        if self._target is not None and frame == self._target[1] > 1:
            for link in self._links:
                link.set_target(self._target[0])
