# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The path of every image through a node: read, fed to a tracker, answered once."""

from __future__ import annotations

import traceback
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Protocol

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError, brief
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.parameters.configuration import Configuration, NodeParameters
from vehicle_pf_tracker.ros.messages import REJECTED_MESSAGE
from vehicle_pf_tracker.ros.node.answer import Answer
from vehicle_pf_tracker.ros.node.image_input import read_image
from vehicle_pf_tracker.ros.node.incidents import IncidentRecorder
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.node.kept_target import KeptTarget
from vehicle_pf_tracker.ros.serialized_image import ImageMessage
from vehicle_pf_tracker.trackers.attempts import TrackerError, unexpected


class Feed(Protocol):
    """A tracker, or the many of traffic, as a node feeds it."""

    @property
    def facts(self) -> Mapping[str, object]:
        """Values for the node's report, by name: choices that the parameters leave open."""

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height of the images, px; None before the first."""

    @property
    def followed(self) -> Box | None:
        """Box of the target while it is visible; None where there is none."""

    def take(self, image: Frame | CodedImage, header: Header, detections: Any) -> Answer:
        """Follow in an image.

        Raises
        ------
        InputError
            If the image cannot be used.
        """

    def start_on(self, box: Box) -> None:
        """Start on `box` with the next image."""

    def reset(self) -> str:
        """Go back to the configured target; return words about that for people.

        Raises
        ------
        InputError
            With the reason, where it is not possible.
        """

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images."""


class AnswerOutputs(Protocol):
    """Publishers of the answers of a feed."""

    def send(self, answer: Answer, own: NodeParameters, *, is_kept: bool) -> DiagnosticArray | None:
        """Publish an answer, its `~/mode` last; returns that, if it was made."""


class ImagePath:
    """The path of images through a configured node.

    Parameters
    ----------
    node : Node
        For its name.
    configuration : Configuration
        The node's parameters.
    feed : Feed
        Tracker, or trackers, that follow in the images.
    outputs : AnswerOutputs
        Publishers of the answers.
    journal : Journal
        Log and counts.

    Attributes
    ----------
    journal : Journal
        As given.
    incidents : IncidentRecorder or None
        Keeps the last seconds; None where that is off.
    """

    def __init__(
        self,
        node: Node,
        configuration: Configuration,
        feed: Feed,
        outputs: AnswerOutputs,
        journal: Journal,
    ) -> None:
        self._configuration = configuration
        self._feed = feed
        self._outputs = outputs
        self.journal = journal
        self._frame_id: str | None = None
        self._refusal = ""
        own = configuration.node
        memory = own.incident_memory * 10**6
        name = str(node.get_fully_qualified_name())
        self.incidents = IncidentRecorder(name, memory) if memory else None
        self._kept = KeptTarget(name) if own.keep_target else None
        # Last: it starts the feed on the target, and logs.
        self._go_on_with_kept()

    def take(self, message: ImageMessage, detections: Any = None) -> None:
        """Take an image, with its detections where it has some; answer it with one `~/mode`."""
        header = message.header
        if self.incidents is not None:
            self.incidents.keep(message)  # first: an image that fails belongs to the last seconds
        try:
            answer = self._feed.take(read_image(message), header, detections)
        except InputError as error:
            self._send(self._rejected(header, str(error)))
        except Exception as error:  # whatever a tracker raises
            # One image must not end a node that others rely on; a broken tracker must.
            self.journal.errors.say("error", traceback.format_exc())
            self._send(self._rejected(header, unexpected(error)))
            # Answered first, then raised: the one `~/mode` of each image is what a replay waits
            # for.
            if not isinstance(error, TrackerError) or error.persists:
                raise
        else:
            # Only of an image that was used: a stray must not decide what positions are measured
            # in.
            self._frame_id = header.frame_id
            self._send(answer)
            self._keep_target()

    def refuse(self, what: str, reason: str) -> None:
        """Report a request that cannot be met: in the log, and in the answer to the next image."""
        self.journal.refuse(what, reason)
        self._refusal = f"{what} refused: {reason}"

    def _send(self, answer: Answer) -> None:
        """Publish and count an answer; what led to a new start of the tracker is written first."""
        if self._refusal:
            events = [event for event in (answer.values.get("event"), self._refusal) if event]
            values = {**answer.values, "event": "; ".join(map(str, events))}
            answer = replace(answer, values=values)
            self._refusal = ""
        if answer.is_restart:
            # Before the new answer is kept, so that the recording ends with what went wrong.
            self._note_restart()
        self.journal.health.answered(answer.mode, answer.step_ms)
        own = self._configuration.node
        is_kept = self.incidents is not None
        mode = self._outputs.send(answer, own, is_kept=is_kept)
        if self.incidents is not None and mode is not None:
            self.incidents.keep(mode, self._feed.followed)

    def _rejected(self, header: Header, reason: str) -> Answer:
        self.journal.health.rejections.add(reason)
        self.journal.errors.say("rejected", f"image rejected: {reason}")
        return Answer(header=header, mode=REJECTED_MESSAGE, values={"reason": reason})

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images."""
        self._configuration = configuration
        self._feed.reconfigure(configuration)

    def check(self, configuration: Configuration) -> None:
        """Refuse a configuration with a new target that is outside the images.

        Raises
        ------
        InputError
            With the reason.
        """
        box = configuration.session.target.box
        size = self._feed.size
        # Only a target that is new: the images may have become smaller than an old one, and other
        # parameters are to be set all the same.
        if box is not None and box != self._configuration.session.target.box and size:
            check_target(box, *size)

    def check_frame_id(self, topic: str, header: Header) -> None:
        """Refuse a position in another frame than that of the images, or of the node's own outputs.

        Raises
        ------
        InputError
            If it is.
        """
        own = self._frame_id
        given = header.frame_id
        suffix = self._configuration.node.output_frame_suffix
        if own is not None and given not in ("", own, own + suffix):
            raise InputError(
                f"{topic} got a target in the frame {brief(given)}; give it in pixels of the "
                f"image, with the image's frame_id {brief(own)} or none"
            )

    def write_incident(self) -> str:
        """Begin to write the last seconds to a recording; return words about that.

        Raises
        ------
        InputError
            If nothing was kept, or it cannot be written.
        """
        assert self.incidents is not None
        log = self.journal.log
        folder = self.incidents.write(self._configuration, lambda words: log.warning(words))  # noqa: PLW0108
        return f"writing to {folder}"

    def _note_restart(self) -> None:
        """Count that the tracker started anew, and write what led to it."""
        self.journal.health.restarts += 1
        if self.incidents is not None:
            try:
                self.write_incident()
            except InputError as error:
                self.journal.log.error(f"the last seconds cannot be written: {error}")

    def _go_on_with_kept(self) -> None:
        """Start on the target of a node that was killed a moment ago, if it can be used."""
        try:
            box = self._kept.load() if self._kept else None
        except InputError as error:
            self.journal.log.warning(f"the kept target is left out: {error}")
            return
        if box is not None:
            self.journal.log.info(f"going on with the target {box} of before")
            self._feed.start_on(box)

    def _keep_target(self) -> None:
        """Save the target for a new start; a disk that is full costs no image its answer."""
        try:
            if self._kept is not None:
                self._kept.save(self._feed.followed)
        except OSError as error:
            words = f"the target cannot be saved: {error.strerror or error}"
            self.journal.warnings.say("kept", words)
