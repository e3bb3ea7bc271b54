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

"""Replaying a recording from start to end: transport, nodes, target, player, report.

Ctrl-C as an event, not as an exception raised anywhere.
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.topics import COMPRESSED_IMAGE
from vehicle_pf_tracker.ros.replay.discovery import Interrupted, Lookout, Spinner
from vehicle_pf_tracker.ros.replay.playable import Playable
from vehicle_pf_tracker.ros.replay.player import Player
from vehicle_pf_tracker.ros.replay.publishing import TopicPublisher, decompressed, make_publishers
from vehicle_pf_tracker.ros.replay.replay_options import (
    NodeReport,
    Progress,
    ReplayOptions,
    ReplayReport,
)
from vehicle_pf_tracker.ros.replay.starting_target import Targets, first_image, starting_target
from vehicle_pf_tracker.ros.replay.tracker_link import TrackerLink
from vehicle_pf_tracker.ros.transport import image_transport


@contextmanager
def noted_interrupts() -> Iterator[threading.Event]:
    """Return an event that SIGINT, SIGTERM and SIGHUP set, however often they come.

    SIGHUP, from a terminal that closes, would otherwise leave the segments in shared memory. Launch
    files send SIGINT twice, and the second must not break the cleaning up. Outside of the main
    thread, where Python allows no handlers, signals stay as they are.
    """
    noted = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield noted
        return

    def note(*_: Any) -> None:
        noted.set()

    numbers = [signal.SIGINT, signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # as nohup sets it
        numbers.append(signal.SIGHUP)
    before = {number: signal.signal(number, note) for number in numbers}
    try:
        yield noted
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


NODE_NAME = "bag_replay"


class NoTargetError(InputError):
    """Tracker nodes are there, but no target for them."""


def replay(
    recording: Playable,
    options: ReplayOptions,
    on_progress: Callable[[Progress], None] = lambda progress: None,
    tell: Callable[[str], None] = lambda sentence: None,
    watch: Callable[[], None] = lambda: None,
) -> ReplayReport:
    """Play a recording to tracker nodes and collect what they answer.

    It brings its own ROS context, so that it can run in a process that has others; the transport
    is set up for the images only if it is the first there.

    Parameters
    ----------
    recording : Playable
        What to play, a `recordings.reader.Recording` for instance.
    options : ReplayOptions
        How to play it.
    on_progress : callable
        Called after each image.
    tell : callable
        Called with sentences for the user while it is getting ready.
    watch : callable
        Called all the time; raises to end the replay, as when a node's process has ended.

    Raises
    ------
    NoTargetError
        If there are tracker nodes, but neither a target nor truth.
    InputError
        If a node is missing, refuses the target or does not answer in time.
    """
    with noted_interrupts() as stop, _ros_node(recording, options, tell) as node:
        spinner = Spinner(node, stop, watch)
        try:
            return _Replay(node, spinner, recording, options, tell).run(on_progress)
        finally:
            spinner.close()


class _Replay:
    """One replay on a node that is ready."""

    def __init__(
        self,
        node: Node,
        spinner: Spinner,
        recording: Playable,
        options: ReplayOptions,
        tell: Callable[[str], None],
    ) -> None:
        self._node = node
        self._spinner = spinner
        self._recording = recording
        self._options = options
        self._tell = tell
        self._publishers, notices = make_publishers(node, recording, options)
        for notice in notices:
            tell(notice)
        self._links: list[TrackerLink] = []
        self._player = Player(node, spinner, recording, options, self._publishers, self._links)

    def run(self, on_progress: Callable[[Progress], None]) -> ReplayReport:
        """Prepare, play and report; an interruption ends the replay early, with its report."""
        began = time.monotonic()
        try:
            targets = self._get_ready()
            began = time.monotonic()
            self._player.play(targets, on_progress)
        except Interrupted:
            return self._report(began, interrupted=True)
        return self._report(began, interrupted=False)

    def _get_ready(self) -> Targets:
        options, images = self._options, self._publishers.get(self._recording.image_topic)
        if images is not None:
            self._await_subscriber(images)
            self._connect(images)
        elif options.lockstep or options.nodes or options.wait_for_subscribers:
            raise InputError(
                f"the image topic {self._recording.image_topic} is not played; "
                "add it to --topics, or leave out what waits for it"
            )
        targets = self._targets()
        self._spinner.until_time(time.monotonic() + options.delay)
        return targets

    def _await_subscriber(self, images: TopicPublisher) -> None:
        if self._options.wait_for_subscribers and not images.subscription_count():
            self._tell(f"waiting for a subscriber of {images.name}")
            self._spinner.until(lambda: images.subscription_count() > 0)

    def _connect(self, images: TopicPublisher) -> None:
        """Link the nodes, and wait until images and answers will reach each other."""
        options = self._options
        lookout = Lookout(self._node, self._spinner, images.name)
        if options.nodes:
            names = lookout.await_named(options.nodes, options.timeout)
        else:
            names = lookout.find(options.timeout if options.lockstep else 0.0)
        if not names:
            if options.lockstep:
                raise InputError(lookout.nobody())
            self._tell(lookout.nobody())
        self._links += [
            TrackerLink(self._node, self._spinner, name, options.timeout) for name in names
        ]
        for link in self._links:
            link.greet()
        self._spinner.until(lambda: images.subscription_count() >= len(names), options.timeout)

    def _targets(self) -> Targets:
        target = None
        if self._links and self._options.set_target:
            target = starting_target(self._recording, self._options)
            if target is None:
                raise NoTargetError(
                    f"the recording {self._recording.path} has no true box to start on; "
                    "give --target x,y,w,h, or --no-target to leave the nodes' targets alone"
                )
        return Targets(self._links, target)

    def _report(self, began: float, interrupted: bool) -> ReplayReport:
        return ReplayReport(
            frames=self._player.frames,
            messages=self._player.messages,
            seconds=time.monotonic() - began,
            nodes=tuple(
                NodeReport(
                    link.name,
                    link.answers.count,
                    link.answers.rows(),
                    link.answers.road_columns(),
                )
                for link in self._links
            ),
            notices=self._player.notices,
            interrupted=interrupted,
        )


@contextmanager
def _ros_node(
    recording: Playable, options: ReplayOptions, tell: Callable[[str], None]
) -> Iterator[Node]:
    """Make the player's node in a context of its own, with room for the images on the way."""
    context = Context()
    size = _image_bytes(recording, options)
    with image_transport(size, rclpy.get_rmw_implementation_identifier()) as notices:
        for notice in notices:
            tell(notice)
        _initialise(context, options)
        try:
            node = Node(NODE_NAME, context=context, enable_rosout=False)
            yield node
            node.destroy_node()
        finally:
            rclpy.try_shutdown(context=context)


def _initialise(context: Context, options: ReplayOptions) -> None:
    arguments = ["--ros-args", *options.ros_args] if options.ros_args else []
    try:
        rclpy.init(
            args=[NODE_NAME, *arguments],
            context=context,
            signal_handler_options=SignalHandlerOptions.NO,
        )
    except RuntimeError as error:
        reason = str(error).splitlines()[0]
        raise InputError(f"the words after --ros-args are not understood: {reason}") from error


def _image_bytes(recording: Playable, options: ReplayOptions) -> int:
    """Size of the published images in bytes, judged by the first."""
    first = first_image(recording, options)
    if options.decompress and recording.image_type == COMPRESSED_IMAGE:
        return len(decompressed(first.data).data)
    return len(first.data)
