# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Replaying a recording from start to end: transport, nodes, target, player, report."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.signals import ending_signals, handled
from vehicle_pf_tracker.recordings.bags.messages import COMPRESSED_IMAGE
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.ros.replay.discovery import Spinner
from vehicle_pf_tracker.ros.replay.pausing import keys_at_once
from vehicle_pf_tracker.ros.replay.player import Player
from vehicle_pf_tracker.ros.replay.publishing import decompressed
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replay_report import ReplayReport
from vehicle_pf_tracker.ros.replay.starting_target import first_image
from vehicle_pf_tracker.ros.transport import image_transport


@contextmanager
def noted_interrupts() -> Iterator[threading.Event]:
    """Return an event that SIGINT, SIGTERM and SIGHUP set, however often they come.

    SIGHUP, from a terminal that closes, would otherwise leave the segments in shared memory. Launch
    files send SIGINT twice, and the second must not break the cleaning up. Outside of the main
    thread, where Python allows no handlers, signals stay as they are.
    """
    noted = threading.Event()
    with handled(ending_signals(), lambda *_: noted.set()):
        yield noted


NODE_NAME = "bag_replay"
"""Name of the player's node, that of its executable."""


def replay(
    recording: Recording,
    options: ReplayOptions,
    on_progress: Callable[[int, float | None], None] = lambda frames, share: None,
    tell: Callable[[str], None] = lambda sentence: None,
) -> ReplayReport:
    """Play a recording to tracker nodes and collect what they answer.

    It brings its own ROS context, so that it can run in a process that has others; the transport
    is set up for the images only if it is the first there.

    Parameters
    ----------
    recording : Recording
        Recording to play.
    options : ReplayOptions
        Options of the replay.
    on_progress : callable
        As `Player` calls it.
    tell : callable
        Called with sentences for the user while it is getting ready.

    Raises
    ------
    NoTargetError
        If there are tracker nodes, but neither a target nor truth.
    InputError
        If a node is missing, refuses the target or does not answer in time.
    """
    with noted_interrupts() as stop, _ros_node(recording, options, tell) as node:
        spinner = Spinner(node, stop)
        try:
            with keys_at_once():
                return Player(node, spinner, recording, options, on_progress, tell).run()
        finally:
            spinner.close()


@contextmanager
def _ros_node(
    recording: Recording, options: ReplayOptions, tell: Callable[[str], None]
) -> Iterator[Node]:
    """Make the player's node in a context of its own, with room for the images on the way."""
    context = Context()
    data = first_image(recording, options).data  # the others are about as large
    is_turned = options.decompress and recording.image_type == COMPRESSED_IMAGE
    size = len(decompressed(data).data if is_turned else data)
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
    words = [NODE_NAME, "--ros-args", *options.ros_args]
    try:
        rclpy.init(args=words, context=context, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        reason = str(error).splitlines()[0]
        raise InputError(f"the words after --ros-args are not understood: {reason}") from error
