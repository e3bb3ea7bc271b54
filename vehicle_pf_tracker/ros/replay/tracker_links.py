# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracker nodes that take part in a replay: found, linked, asked for their answers."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from rclpy.node import Node
from rclpy.publisher import Publisher

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.replay.discovery import Lookout, Spinner
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.tracker_link import TrackerLink


class TrackerLinks:
    """Links to all tracker nodes that take part.

    Parameters
    ----------
    node : Node
        The player's own node.
    spinner : Spinner
        Runs the callbacks while waiting.
    options : ReplayOptions
        Options of the replay.
    tell : callable
        Called with sentences for the user while it is getting ready.

    Attributes
    ----------
    links : list of TrackerLink
        A link to each node; empty before `connect`.
    """

    def __init__(
        self, node: Node, spinner: Spinner, options: ReplayOptions, tell: Callable[[str], None]
    ) -> None:
        self.links: list[TrackerLink] = []
        self._node = node
        self._spinner = spinner
        self._options = options
        self._tell = tell

    def connect(self, images: Publisher) -> None:
        """Link the nodes, and wait until images and answers will reach each other.

        Raises
        ------
        InputError
            If a node is missing or does not answer in time.
        """
        options = self._options
        count = images.get_subscription_count
        if options.wait_for_subscribers and not count():
            self._tell(f"waiting for a subscriber of {images.topic_name}")
            self._spinner.until(lambda: count() > 0)
        lookout = Lookout(self._node, self._spinner, images.topic_name)
        if options.nodes:
            names = lookout.await_named(options.nodes, options.timeout)
        else:
            names = lookout.find(options.timeout if options.lockstep else 0.0)
        if not names:
            if options.lockstep:
                raise InputError(lookout.nobody())
            self._tell(lookout.nobody())
        self.links += [
            TrackerLink(self._node, self._spinner, name, options.timeout) for name in names
        ]
        for link in self.links:
            link.greet()
        # A greeting shows that the nodes know the publisher; the count, that it knows them.
        self._spinner.until(lambda: count() >= len(names), options.timeout)

    def begin_pass(self) -> None:
        """Discard the answers to earlier frames, as each pass of a loop does."""
        for link in self.links:
            link.answers.begin_pass()

    def expect(self, frame: int, stamp_ns: int) -> None:
        """Note that the image number `frame` was published; in lock-step, wait for its answers.

        Raises
        ------
        InputError
            If a node does not answer in time.
        """
        for link in self.links:
            link.answers.expect(frame, stamp_ns)
        for link in self.links if self._options.lockstep else ():
            if not link.await_answer(frame, self._options.timeout):
                raise InputError(
                    f"the node {link.name} did not answer frame {frame} "
                    f"(stamp {stamp_ns} ns) within {self._options.timeout:g} s"
                )

    def await_last(self, frame: int) -> None:
        """Wait for the answers to the last image; 0 of a pass without any.

        Nodes answer in order: with the last answer in, what is missing was dropped.
        """
        for link in self.links if frame else ():
            link.await_answer(frame, self._options.timeout)

    def loss_notices(self, frames: int, *, is_interrupted: bool) -> Iterator[str]:
        """Say which nodes have not answered all of so many images, a sentence each."""
        for link in self.links:
            losses = link.answers.losses()
            # An interruption leaves the last image without its answer, which is no loss.
            if losses.total > is_interrupted:
                yield losses.sentence(link.name, frames)
