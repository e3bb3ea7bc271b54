"""The bag player: a recording goes out, and what tracker nodes answer comes in."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from vehicle_pf_tracker.features.errors import InputError
from vehicle_pf_tracker.ros.pacing import Pace
from vehicle_pf_tracker.ros.playable import Playable, PlayableMessage
from vehicle_pf_tracker.ros.publishing import TopicPublisher
from vehicle_pf_tracker.ros.replay_options import Progress, ReplayOptions
from vehicle_pf_tracker.ros.spinner import Spinner
from vehicle_pf_tracker.ros.starting_target import Targets
from vehicle_pf_tracker.ros.tracker_link import TrackerLink

_ACKNOWLEDGEMENT_SLICE = 0.05


class Player:
    """Publishes a recording once or in a loop, in lock-step or at the pace of its log times.

    Parameters
    ----------
    node : Node
        The player's own node.
    spinner : Spinner
        Runs the callbacks while waiting.
    recording : Playable
        What to play.
    options : ReplayOptions
        How to play it.
    publishers : dict of str to TopicPublisher
        By recorded topic.
    links : list of TrackerLink
        The nodes that take part.

    Attributes
    ----------
    frames, messages : int
        Images and messages published so far, in all passes.
    notices : list of str
        What was skipped and why, a sentence each.
    """

    def __init__(
        self,
        node: Node,
        spinner: Spinner,
        recording: Playable,
        options: ReplayOptions,
        publishers: dict[str, TopicPublisher],
        links: list[TrackerLink],
    ) -> None:
        self.frames = self.messages = 0
        self.notices: list[str] = []
        self._spinner = spinner
        self._recording = recording
        self._options = options
        self._publishers = publishers
        self._links = links
        self._frame = 0
        self._pace = Pace(options.rate or (None if options.lockstep else 1.0))
        self._clock = node.create_publisher(Clock, "/clock", 10) if options.clock else None
        if options.clock:
            steady = RosClock(clock_type=ClockType.STEADY_TIME)
            node.create_timer(1 / options.clock, self._publish_clock, clock=steady)

    def play(self, targets: Targets, on_progress: Callable[[Progress], None]) -> None:
        """Play until the end, or until interrupted when looping.

        Raises
        ------
        InputError
            If a node does not answer in time in lock-step.
        Interrupted
            If the user asks to end.
        """
        while True:
            self._play_pass(targets, on_progress)
            self._await_last_answers()
            if not self._options.loop:
                return

    def _play_pass(self, targets: Targets, on_progress: Callable[[Progress], None]) -> None:
        self._pace.restart()
        self._frame = 0
        for link in self._links:
            link.answers.begin_pass()
        targets.begin_pass()
        first_ns, length_ns = self._span()
        for message in self._selected():
            targets.before(message)
            self._spinner.until_time(self._pace.due(message.log_time_ns))
            if self._publish(message) and message.topic == self._recording.image_topic:
                self._follow(message)
                position_ns = message.log_time_ns - first_ns
                on_progress(Progress(self.frames, position_ns * 1e-9, length_ns * 1e-9))

    def _selected(self) -> Iterator[PlayableMessage]:
        options = self._options
        return self._recording.messages(
            set(self._publishers), options.start_offset, options.playback_duration
        )

    def _span(self) -> tuple[int, int]:
        """Log time at which the part to play begins, and its length, in ns."""
        first_ns = self._recording.start_ns + round(self._options.start_offset * 1e9)
        length_ns = max(self._recording.end_ns - first_ns, 0)
        if self._options.playback_duration is not None:
            length_ns = min(length_ns, round(self._options.playback_duration * 1e9))
        return first_ns, length_ns

    def _publish(self, message: PlayableMessage) -> bool:
        """Publish a message; False if it is not fit to be."""
        if message.topic == self._recording.image_topic:
            if message.stamp_ns is None:
                self.notices.append(f"skipped an image of {message.topic} that has no header")
                return False
            self._frame += 1
            for link in self._links:
                link.answers.expect(self._frame, message.stamp_ns)
        if self._clock is not None and self._options.lockstep:
            self._publish_clock()
        try:
            self._publishers[message.topic].publish(message.data)
        except InputError as error:
            self.notices.append(f"skipped a message of {message.topic}: {error}")
            return False
        self.messages += 1
        return True

    def _follow(self, message: PlayableMessage) -> None:
        self.frames += 1
        if not self._options.lockstep:
            return
        for link in self._links:
            if not self._spinner.until(self._has_answered(link), self._options.timeout):
                raise InputError(
                    f"the node {link.name} did not answer frame {self._frame} "
                    f"(stamp {message.stamp_ns} ns) within {self._options.timeout:g} s"
                )

    def _has_answered(self, link: TrackerLink) -> Callable[[], bool]:
        frame = self._frame
        return lambda: link.answers.has(frame)

    def _await_last_answers(self) -> None:
        """Wait for acknowledgement, then for the answers to the last image.

        Nodes answer in order: with the last one in, what is missing was dropped. It may be dropped
        itself, so no longer than the timeout without any answer.
        """
        deadline = time.monotonic() + self._options.timeout
        while not self._is_acknowledged() and time.monotonic() < deadline:
            self._spinner.check()
        for link in self._links if self._frame else ():
            count = -1
            while count < link.answers.count:
                count = link.answers.count
                self._spinner.until(self._has_news(link, count), self._options.timeout)
                if link.answers.has(self._frame):
                    break

    def _has_news(self, link: TrackerLink, count: int) -> Callable[[], bool]:
        return lambda: link.answers.count > count or link.answers.has(self._frame)

    def _is_acknowledged(self) -> bool:
        return all(
            publisher.is_acknowledged(_ACKNOWLEDGEMENT_SLICE)
            for publisher in self._publishers.values()
        )

    def _publish_clock(self) -> None:
        seconds, nanoseconds = divmod(self._pace.log_time_ns(), 1_000_000_000)
        message = Clock()
        message.clock.sec, message.clock.nanosec = seconds, nanoseconds
        assert self._clock is not None
        self._clock.publish(message)
