"""Replaying a recording from start to end: transport, nodes, target, player, report."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from vehicle_pf_tracker.features.errors import InputError
from vehicle_pf_tracker.recordings.topics import COMPRESSED_IMAGE
from vehicle_pf_tracker.ros import discovery
from vehicle_pf_tracker.ros.playable import Playable
from vehicle_pf_tracker.ros.player import Player
from vehicle_pf_tracker.ros.publishing import TopicPublisher, decompressed, make_publishers
from vehicle_pf_tracker.ros.replay_options import (
    NodeReport,
    Progress,
    ReplayOptions,
    ReplayReport,
)
from vehicle_pf_tracker.ros.spinner import Interrupted, Spinner, interruptible
from vehicle_pf_tracker.ros.starting_target import (
    StartingTarget,
    Targets,
    first_image,
    starting_target,
)
from vehicle_pf_tracker.ros.tracker_link import TrackerLink
from vehicle_pf_tracker.ros.transport import image_transport

NODE_NAME = "bag_replay"
_DISCOVERY = 3.0
"""Longest look-out for tracker nodes in s if none are named."""
_QUIET = 1.0
"""The look-out ends so many s after the last node was found."""


class NoTargetError(InputError):
    """Tracker nodes are there, but no target for them."""


def replay(
    recording: Playable,
    options: ReplayOptions,
    on_progress: Callable[[Progress], None] = lambda progress: None,
    tell: Callable[[str], None] = lambda sentence: None,
) -> ReplayReport:
    """Play a recording to tracker nodes and collect what they answer.

    It brings its own ROS context, so that it can run in a process that has others.

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

    Raises
    ------
    NoTargetError
        If there are tracker nodes, but neither a target nor truth.
    InputError
        If a node is missing, refuses the target or does not answer in time.
    """
    target = starting_target(recording, options) if options.set_target else None
    with _ros_node(recording, options, tell) as node:
        spinner = Spinner(node)
        try:
            with interruptible(spinner):
                return _Replay(node, spinner, recording, options, tell).run(target, on_progress)
        finally:
            spinner.close()


class _Replay:
    """One replay on a node that is ready; the order of the steps in `run` matters."""

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

    def run(
        self, target: StartingTarget | None, on_progress: Callable[[Progress], None]
    ) -> ReplayReport:
        began = time.monotonic()
        interrupted = False
        try:
            self._get_ready(target)
            began = time.monotonic()
            targets = Targets(self._links, target, self._recording.image_topic)
            self._player.play(targets, on_progress)
        except Interrupted:
            interrupted = True
        return ReplayReport(
            frames=self._player.frames,
            messages=self._player.messages,
            seconds=time.monotonic() - began,
            nodes=tuple(
                NodeReport(link.name, link.answers.count, link.answers.rows())
                for link in self._links
            ),
            notices=tuple(self._player.notices),
            interrupted=interrupted,
        )

    def _get_ready(self, target: StartingTarget | None) -> None:
        images = self._publishers.get(self._recording.image_topic)
        if images is None:
            self._check_images_unneeded()
        else:
            self._connect(images, target)
            if self._options.wait_for_subscribers and not images.subscription_count():
                self._tell(f"waiting for a subscriber of {images.name}")
                self._spinner.until(lambda: images.subscription_count() > 0)
        self._spinner.until_time(time.monotonic() + self._options.delay)

    def _check_images_unneeded(self) -> None:
        if self._options.lockstep or self._options.nodes or self._options.wait_for_subscribers:
            raise InputError(
                f"the image topic {self._recording.image_topic} is not played; "
                "add it to --topics, or leave out what waits for it"
            )

    def _connect(self, images: TopicPublisher, target: StartingTarget | None) -> None:
        names = self._named_nodes(images) if self._options.nodes else self._found_nodes(images)
        if not names and self._options.lockstep:
            raise InputError(_nobody(self._node, images.name))
        if not names:
            self._tell(_nobody(self._node, images.name))
        if names and target is None and self._options.set_target:
            raise NoTargetError(
                f"the recording {self._recording.path} has no true box to start on; "
                "give --target x,y,w,h, or --no-target to leave the nodes' targets alone"
            )
        for name in names:
            link = TrackerLink(self._node, self._spinner, name, self._options.timeout)
            self._links.append(link)
        for link in self._links:
            link.greet()
        self._spinner.until(
            lambda: images.subscription_count() >= len(names), self._options.timeout
        )

    def _named_nodes(self, images: TopicPublisher) -> list[str]:
        names = list(dict.fromkeys(map(discovery.full_name, self._options.nodes)))
        timeout = self._options.timeout
        for name in names:
            if not self._spinner.until(self._listens(name, images), timeout):
                raise InputError(_not_listening(self._node, name, images.name, timeout))
        return names

    def _listens(self, name: str, images: TopicPublisher) -> Callable[[], bool]:
        return lambda: name in discovery.subscribers(self._node, images.name)

    def _found_nodes(self, images: TopicPublisher) -> list[str]:
        found: set[str] = set()
        deadline = time.monotonic() + _DISCOVERY

        def grows() -> bool:
            listening = discovery.subscribers(self._node, images.name)
            now = discovery.tracker_nodes(self._node) & listening
            new = bool(now - found)
            found.update(now)
            return new

        while self._spinner.until(grows, _QUIET if found else deadline - time.monotonic()):
            pass
        return sorted(found)


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
            node = Node(
                NODE_NAME, context=context, enable_rosout=False, start_parameter_services=False
            )
            yield node
            node.destroy_node()
        finally:
            rclpy.try_shutdown(context=context)


def _initialise(context: Context, options: ReplayOptions) -> None:
    arguments = [NODE_NAME, "--ros-args", *options.ros_args] if options.ros_args else [NODE_NAME]
    try:
        rclpy.init(args=arguments, context=context, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        reason = str(error).splitlines()[0]
        raise InputError(f"the words after --ros-args are not understood: {reason}") from error


def _image_bytes(recording: Playable, options: ReplayOptions) -> int:
    first = first_image(recording, options)
    if first is None:
        return 0
    if options.decompress and recording.image_type == COMPRESSED_IMAGE:
        return len(decompressed(first.data).data)
    return len(first.data)


def _nobody(node: Node, topic: str) -> str:
    trackers = sorted(discovery.tracker_nodes(node))
    if not trackers:
        return f"no tracker node subscribes to {topic}"
    return f"no tracker node subscribes to {topic}: {_inputs(node, trackers[0])}"


def _not_listening(node: Node, name: str, topic: str, timeout: float) -> str:
    return (
        f"the node {name} does not subscribe to {topic} after {timeout:g} s: {_inputs(node, name)}"
    )


def _inputs(node: Node, name: str) -> str:
    inputs = discovery.image_inputs(node, name)
    if not inputs:
        return f"{name} has no image input; is it running and active?"
    return f"{name} listens to {', '.join(inputs)}; see --remap"
