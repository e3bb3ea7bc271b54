# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The way of every image through a node: read, fed to the session, answered once."""

from __future__ import annotations

import traceback
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from rclpy.node import Node
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.compressed_image import CodedImage
from vehicle_pf_tracker.image.target_pixels import doubts
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import REJECTED, stamp_ns
from vehicle_pf_tracker.ros.node.diagnostics import Health
from vehicle_pf_tracker.ros.node.image_input import read_image
from vehicle_pf_tracker.ros.node.incidents import IncidentRecorder
from vehicle_pf_tracker.ros.node.kept_target import KeptTarget
from vehicle_pf_tracker.ros.node.notices import Notices
from vehicle_pf_tracker.ros.node.outputs import Outputs
from vehicle_pf_tracker.trackers.session import TrackerError, unexpected


class NodeStream(ABC):
    """Processing of images in a configured node.

    Parameters
    ----------
    node : Node
        For its log.
    configuration : Configuration
        The node's parameters.
    outputs : Outputs
        Publishers of the answers.
    health : Health
        Counts what happens.

    Attributes
    ----------
    log : RcutilsLogger
        The node's log.
    warnings, errors : Notices
        Lines in it that would come with every image.
    health : Health
        As given.
    incidents : IncidentRecorder or None
        Keeps the last seconds; None where that is off.
    frame_id : str or None
        Frame of the last image that was used; None before the first.
    """

    def __init__(
        self, node: Node, configuration: Configuration, outputs: Outputs, health: Health
    ) -> None:
        self.log = node.get_logger()
        # A line of code each: rclpy refuses to log with two severities from one.
        self.warnings = Notices(lambda words: self.log.warning(words))  # noqa: PLW0108
        self.errors = Notices(lambda words: self.log.error(words))  # noqa: PLW0108
        self._configuration = configuration
        self._publish_mode = outputs.publish_mode
        self.health = health
        self.frame_id: str | None = None
        own, name = configuration.node, str(node.get_name())
        memory = own.incident_memory * 10**6
        self.incidents = IncidentRecorder(name, memory) if memory else None
        self._kept = KeptTarget(node.get_fully_qualified_name()) if own.keep_target else None
        self._go_on_with_kept()

    def _go_on_with_kept(self) -> None:
        """Start on the target of a node that was killed a moment ago, if it can be used."""
        try:
            box = self._kept.load() if self._kept else None
        except InputError as error:
            self.log.warning(f"the kept target is left out: {error}")
            return
        if box is not None:
            self.log.info(f"going on with the target {box} of before")
            self.start_on(box)

    @property
    @abstractmethod
    def facts(self) -> Mapping[str, object]:
        """Values for the node's report, by name: choices that the parameters leave open."""

    @abstractmethod
    def take(self, message: Image | CompressedImage) -> None:
        """Take an image, which is answered with exactly one `~/mode`."""

    @property
    @abstractmethod
    def size(self) -> tuple[int, int] | None:
        """Width and height of the stream's images, px; None before the first."""

    @property
    @abstractmethod
    def followed(self) -> Box | None:
        """Box of the target while it is visible; None where there is none."""

    @abstractmethod
    def start_on(self, box: Box) -> None:
        """Start on `box` with the next image."""

    @abstractmethod
    def reset(self) -> str:
        """Go back to the configured target; return words about that for people.

        Raises
        ------
        InputError
            With the reason, where it is not possible.
        """

    @abstractmethod
    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images."""

    def check(self, configuration: Configuration) -> None:
        """Refuse a configuration with a new target that is outside the stream's images.

        Raises
        ------
        InputError
            With the reason.
        """
        box = configuration.session.target.box
        if box is not None and box != self._configuration.session.target.box and self.size:
            check_target(box, *self.size)

    def check_frame_id(self, topic: str, header: Header) -> None:
        """Refuse a position in another frame than that of the images, or of the node's own outputs.

        Raises
        ------
        InputError
            If it is.
        """
        own, found = self.frame_id, header.frame_id
        suffix = self._configuration.node.output_frame_suffix
        if own is not None and found not in ("", own, own + suffix):
            raise InputError(
                f"{topic} got a target in the frame {found!r}; give it in pixels of the image, "
                f"with the image's frame_id {own!r} or none"
            )

    @abstractmethod
    def feed(self, image: Frame | CodedImage, stamp_ns: int, extra: Any) -> None:
        """Feed an image to the session.

        Raises
        ------
        InputError
            If the image cannot be used.
        """

    @abstractmethod
    def answer(self, header: Header, frame: Frame) -> None:
        """Publish all that the session says of the image that it was fed last."""

    def process(self, message: Image | CompressedImage, extra: Any = None) -> None:
        """Read an image, feed it and publish the answer; `extra` is passed on to `feed`."""
        header = message.header
        if self.incidents is not None:
            self.incidents.keep(message)
        try:
            image = read_image(message)
            self.feed(image, stamp_ns(header), extra)
            frame = image.decode() if isinstance(image, CodedImage) else image
        except InputError as error:
            self.decline(header, error)
        except Exception as error:  # whatever a tracker raises
            self._fail(header, error)
        else:
            self.frame_id = header.frame_id
            self.answer(header, frame)
            self._keep_target()

    def _keep_target(self) -> None:
        """Save the target for a new start; a disk that is full costs no image its answer."""
        try:
            if self._kept is not None:
                self._kept.save(self.followed)
        except OSError as error:
            self.warnings.say("kept", f"the target cannot be saved: {error.strerror or error}")

    @contextmanager
    def drawing(self, product: str) -> Iterator[None]:
        """Draw for those who look at it; a drawing that fails costs no image its answer."""
        try:
            yield
        except Exception as error:  # OpenCV's errors, memory
            self.warnings.say(product, f"cannot make {product}: {error or type(error).__name__}")

    def publish_mode(
        self, header: Header, mode: str, values: Mapping[str, object], *, is_doubtful: bool = False
    ) -> None:
        """Publish the one `~/mode` of an image; see `Outputs.publish_mode`."""
        is_kept = self.incidents is not None
        answer = self._publish_mode(header, mode, values, is_doubtful=is_doubtful, is_kept=is_kept)
        if self.incidents is not None and answer is not None:
            self.incidents.keep(answer, self.followed)

    def write_incident(self) -> str:
        """Begin to write the last seconds to a recording; return words about that.

        Raises
        ------
        InputError
            If nothing was kept, or it cannot be written.
        """
        assert self.incidents is not None
        folder = self.incidents.write(self._configuration, lambda words: self.log.warning(words))  # noqa: PLW0108
        return f"writing to {folder}"

    def note_restart(self) -> None:
        """Count that the session started anew, and write what led to it."""
        self.health.restarts += 1
        if self.incidents is not None:
            try:
                self.write_incident()
            except InputError as error:
                self.log.error(f"the last seconds cannot be written: {error}")

    def refuse(self, what: str, reason: str) -> None:
        """Report that a target or a selection cannot be used; all vehicles are kept."""
        self.health.refuse_target(reason)
        self.errors.say(what, f"{what} refused: {reason}")

    @staticmethod
    def doubts(frame: Frame, box: Box) -> list[str]:
        """Return what speaks against a target that was given, a sentence each."""
        return [f"the target is doubtful: {why}" for why in doubts(frame, box)]

    def decline(self, header: Header, error: InputError) -> None:
        """Answer an image that cannot be used."""
        self.health.reject(str(error))
        self.errors.say("rejected", f"image rejected: {error}")
        self.answer_without_estimate(header, REJECTED, str(error))

    def answer_without_estimate(self, header: Header, mode: str, reason: str) -> None:
        """Publish a mode with its reason, and count it."""
        self.health.answered(mode)
        self.publish_mode(header, mode, {"reason": reason})

    def tell_drawn_seed(self, seed: int) -> None:
        """Log a seed that was drawn, so that a run can be repeated."""
        if self._configuration.tracker.seed < 0:
            self.log.info(f"drew the seed {seed}; set it to repeat this run")

    def _fail(self, header: Header, error: Exception) -> None:
        """Reject an image for an unexpected error, and raise it unless it concerns this image only.

        One image must not end a node that others rely on; a broken tracker must.
        """
        self.errors.say("error", traceback.format_exc())
        self.decline(header, InputError(unexpected(error)))
        if not isinstance(error, TrackerError) or error.persists:
            raise error
