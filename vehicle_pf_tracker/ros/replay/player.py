# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The bag player: publishes a recording and collects the tracker nodes' answers."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from rclpy.duration import Duration
from rclpy.node import Node

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.reader import RecordedMessage, Recording
from vehicle_pf_tracker.ros.replay.discovery import Interrupted, Spinner
from vehicle_pf_tracker.ros.replay.pace import PlaybackClock, ReplayPace
from vehicle_pf_tracker.ros.replay.pausing import offer_pausing
from vehicle_pf_tracker.ros.replay.publishing import make_publishers
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replay_report import ReplayReport
from vehicle_pf_tracker.ros.replay.starting_target import Targets, played, starting_target
from vehicle_pf_tracker.ros.replay.tracker_links import TrackerLinks

_ACKNOWLEDGEMENT_SLICE = Duration(seconds=0.05)
"""Longest wait for acknowledgements without a look whether the user asked to end."""


class Player:
    """Publishes a recording once or in a loop, in lock-step or at the pace of its log times.

    Parameters
    ----------
    node : Node
        The player's own node.
    spinner : Spinner
        Runs the callbacks while waiting.
    recording : Recording
        Recording to play.
    options : ReplayOptions
        Options of the replay.
    on_progress : callable
        Called after each image with the number published, and the share of the recording that was
        played; None while that is not known.
    tell : callable
        Called with sentences for the user while it is getting ready.
    """

    def __init__(
        self,
        node: Node,
        spinner: Spinner,
        recording: Recording,
        options: ReplayOptions,
        on_progress: Callable[[int, float | None], None],
        tell: Callable[[str], None],
    ) -> None:
        self._spinner = spinner
        self._recording = recording
        self._options = options
        self._on_progress = on_progress
        # Publishers first: see `TrackerLink`.
        self._publishers, notices = make_publishers(node, recording, options)
        for notice in notices:
            tell(notice)
        self._nodes = TrackerLinks(node, spinner, options, tell)
        self._frames = 0  # in all passes
        self._frame = 0  # in this pass
        self._skipped: list[str] = []
        self._pace = ReplayPace(options.rate or (None if options.lockstep else 1.0))
        self._pace.set_paused(options.start_paused)
        offer_pausing(node, self._pace, tell)
        self._clock = PlaybackClock(node, self._pace, options.clock) if options.clock else None

    def run(self) -> ReplayReport:
        """Prepare, play and report; an interruption ends the replay early, with its report.

        Raises
        ------
        NoTargetError
            If there are tracker nodes, but neither a target nor truth.
        InputError
            If a node is missing, refuses the target or does not answer in time.
        """
        began = time.monotonic()
        is_interrupted = False
        try:
            targets = self._get_ready()
            began = time.monotonic()
            self._play(targets)
        except Interrupted:
            is_interrupted = True
        return ReplayReport(
            frames=self._frames,
            seconds=time.monotonic() - began,
            nodes=tuple(link.report() for link in self._nodes.links),
            notices=tuple(self._notices(is_interrupted=is_interrupted)),
            interrupted=is_interrupted,
        )

    def _notices(self, *, is_interrupted: bool) -> Iterator[str]:
        if self._skipped:
            yield f"skipped {len(self._skipped)} messages; the first, {self._skipped[0]}"
        yield from self._nodes.loss_notices(self._frames, is_interrupted=is_interrupted)

    def _get_ready(self) -> Targets:
        options = self._options
        images = self._publishers.get(self._recording.image_topic)
        if images is not None:
            self._nodes.connect(images.publisher)
        elif options.lockstep or options.nodes or options.wait_for_subscribers:
            raise InputError(
                f"the image topic {self._recording.image_topic} is not played; "
                "add it to --topics, or leave out what waits for it"
            )
        links = self._nodes.links
        has_target = links and options.set_target
        target = starting_target(self._recording, options) if has_target else None
        self._spinner.until_time(time.monotonic() + options.delay)
        return Targets(links, target)

    def _play(self, targets: Targets) -> None:
        """Play until the end, or until interrupted when looping."""
        while True:
            self._spinner.check()
            self._pace.restart()
            self._frame = 0
            self._nodes.begin_pass()
            targets.begin_pass()
            self._play_once(targets)
            self._await_acknowledgement()
            self._nodes.await_last(self._frame)
            if not self._options.loop:
                return

    def _play_once(self, targets: Targets) -> None:
        options = self._options
        begin_ns = self._recording.start_ns + round(options.start_offset * 1e9)
        length_ns = max(self._recording.end_ns - begin_ns, 0)
        if options.playback_duration is not None:
            length_ns = min(length_ns, round(options.playback_duration * 1e9))
        for message in played(self._recording, options, set(self._publishers)):
            is_image = message.topic == self._recording.image_topic
            if is_image:
                targets.before(self._frame + 1)
            self._await_due(message.log_time_ns)
            if self._publish(message, is_image=is_image) and is_image:
                self._follow(message)
            if is_image:
                position_ns = message.log_time_ns - begin_ns
                self._on_progress(self._frames, position_ns / length_ns if position_ns else None)

    def _await_due(self, log_time_ns: int) -> None:
        """Wait until a message is due, and while the replay is paused."""
        self._spinner.until_time(self._pace.due(log_time_ns))
        while self._pace.is_paused:
            self._spinner.until(lambda: not self._pace.is_paused)
            self._spinner.until_time(self._pace.due(log_time_ns))

    def _publish(self, message: RecordedMessage, *, is_image: bool) -> bool:
        """Publish a message; False if it cannot be converted."""
        if self._clock is not None and self._options.lockstep:
            self._clock.publish()
        try:
            if is_image and message.stamp_ns is None:
                raise InputError("it is too short for a header")
            publisher, convert = self._publishers[message.topic]
            publisher.publish(convert(message.data))
        except InputError as error:
            self._skipped.append(f"of {message.topic} at {message.log_time_ns} ns: {error}")
            return False
        return True

    def _follow(self, message: RecordedMessage) -> None:
        """Count an image that was published, and in lock-step wait for its answers."""
        assert message.stamp_ns is not None
        self._frames += 1
        self._frame += 1
        self._nodes.expect(self._frame, message.stamp_ns)

    def _await_acknowledgement(self) -> None:
        """Wait until reliable subscribers have everything, no longer than the timeout."""
        deadline = time.monotonic() + self._options.timeout
        for publisher, _ in self._publishers.values():
            while not publisher.wait_for_all_acked(_ACKNOWLEDGEMENT_SLICE):
                self._spinner.check()
                if time.monotonic() >= deadline:
                    return
