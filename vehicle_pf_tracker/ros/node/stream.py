# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One stream of images through the session of one target, and what is published of it.

Kernels may be loaded meanwhile: until then every image is answered with the reason.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rclpy.node import Node
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.compressed_image import CodedImage
from vehicle_pf_tracker.image.encodings import MAX_SIDE
from vehicle_pf_tracker.image.stillness import Stillness
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import WAITING, stamp_ns
from vehicle_pf_tracker.ros.node.camera_inputs import CameraInputs, StreamLocalisation
from vehicle_pf_tracker.ros.node.diagnostics import Health
from vehicle_pf_tracker.ros.node.kernel_loading import KernelLoading
from vehicle_pf_tracker.ros.node.node_stream import NodeStream
from vehicle_pf_tracker.ros.node.outputs import TrackerOutputs
from vehicle_pf_tracker.trackers.estimate import START, Estimate, Mode
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.trackers.session import Session, TargetError


class Stream(NodeStream):
    """Processing of images and targets in a configured node.

    Parameters
    ----------
    node : Node
        For its log.
    variant : Variant
        Variant from the registry.
    configuration : Configuration
        Parameters of this variant.
    outputs : TrackerOutputs
        Publishers of the estimates.
    health : Health
        Counts what happens.
    cameras : CameraInputs
        Where lens and pose of the camera come from.

    Attributes
    ----------
    asked : Box or None
        Target that the next image starts on; None where none was given.
    estimate : Estimate or None
        The last one; None while there is no target.
    localisation : StreamLocalisation
        Uncertainty of the estimates, and the road.
    """

    def __init__(
        self,
        node: Node,
        variant: Variant,
        configuration: Configuration,
        outputs: TrackerOutputs,
        health: Health,
        cameras: CameraInputs,
    ) -> None:
        self.asked: Box | None = None
        super().__init__(node, configuration, outputs, health)
        self._outputs = outputs
        self._variant = variant
        self._applied = configuration
        self._session: Session | None = None
        self._loading = KernelLoading(self._variant, configuration.tracker)
        self._target_problem = ""
        self._stillness = Stillness()
        self.localisation = StreamLocalisation(variant.name, configuration.session.road, cameras)
        self.estimate: Estimate | None = None
        if not self.get_ready():
            self.log.info(self._loading.reason)

    def get_ready(self) -> bool:
        """Make the session, and take new parameters, as soon as their kernels are loaded.

        Returns
        -------
        bool
            True once images can be tracked in.
        """
        is_applied = self._session is not None and self._applied is self._configuration
        if is_applied or not self._loading.is_done:
            return self._session is not None
        self._applied, seed = self._configuration, None
        tracker, settings = self._configuration.tracker, self._configuration.session
        if self._session is None:
            self._session = Session(self._variant, tracker, settings)
            for notice in self._session.tracker.kernels.notices:
                self.log.warning(notice)
        else:
            seed = self._session.tracker.seed
            self._session.reconfigure(tracker, settings)
        if self._session.tracker.seed != seed:
            self.tell_drawn_seed(self._session.tracker.seed)
        return True

    @property
    def facts(self) -> Mapping[str, object]:
        """The variant, and choices that the parameters leave open: the seed and the kernels."""
        seed, kernels = self._configuration.tracker.seed, self._loading.reason
        if self._session is not None:
            tracker = self._session.tracker
            seed, kernels = tracker.seed, tracker.kernels.name
        return {"variant": self._variant.name, "seed": seed, "kernels": kernels}

    @property
    def target_words(self) -> str:
        """Description of the next target, for people."""
        box = self.asked or self._configuration.session.target.box
        return f"following {box}" if box else "waiting for a target on ~/set_target"

    @property
    def box(self) -> Box | None:
        """The present box: that of the estimate, else the configured one."""
        return self.estimate.box if self.estimate else self._configuration.session.target.box

    def take(self, message: Image | CompressedImage) -> None:
        """Answer an image with exactly one `~/mode`, and with an estimate where there is one."""
        if self.get_ready():
            self.process(message)
        else:
            self._wait(message.header, self._loading.reason)

    def feed(self, image: Frame | CodedImage, stamp_ns: int, _: Any) -> None:
        """Feed an image, after the target that was asked for."""
        assert self._session is not None
        if self.asked is not None:
            self._session.set_target(self.asked)
            self.asked = None
        self.estimate = self._session.feed(image, stamp_ns)

    def decline(self, header: Header, error: InputError) -> None:
        """Answer an image that cannot be used, or that does not fit the target to start on."""
        if isinstance(error, TargetError):
            self._wait(header, str(error))
        else:
            super().decline(header, error)

    @property
    def followed(self) -> Box | None:
        """Box of the target while it is visible; None where there is none."""
        estimate = self.estimate
        return estimate.box if estimate and estimate.mode is Mode.TRACKING else None

    def start_on(self, box: Box) -> None:
        """Start on `box` with the next image, if it fits into that.

        Raises
        ------
        InputError
            If it is no box in any image.
        """
        self.asked = check_target(box, MAX_SIDE, MAX_SIDE)

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height of the stream's images, px; None before the first."""
        return self._session.size if self._session else None

    def reset(self) -> str:
        """Go back to the configured target, or to waiting for one.

        Raises
        ------
        InputError
            If the kernels are not loaded yet, or the configured target is outside the images, so
            that the next ones will not be tracked in.
        """
        if not self.get_ready() or self._session is None:
            raise InputError(self._loading.reason)
        box, size = self._configuration.session.target.box, self.size
        self.asked = self.estimate = None
        self._session.reset()
        self._target_problem = ""
        if box is not None and size is not None:
            try:
                check_target(box, *size)
            except InputError as error:
                self._target_problem = str(error)
                raise InputError(f"{error}; waiting for a target") from None
        return self.target_words

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images, or when their kernels are loaded."""
        if configuration.session.target != self._configuration.session.target:
            self._target_problem = ""
        if configuration.session.road != self._configuration.session.road:
            self.localisation.reconfigure(configuration.session.road)
        self._configuration = configuration
        if configuration.tracker.kernels != self._loading.choice:
            self._loading = KernelLoading(self._variant, configuration.tracker)
        self.get_ready()

    def _wait(self, header: Header, reason: str) -> None:
        """Answer an image in which nothing can be tracked, for this reason."""
        if reason not in (self._loading.reason, self._target_problem):
            self.refuse("target", reason)
            self._target_problem = reason
        self.answer_without_estimate(header, WAITING, reason)

    def answer(self, header: Header, frame: Frame) -> None:
        """Publish the estimate of the last image, and its mode."""
        session, estimate = self._session, self.estimate
        assert session is not None
        own, mode, words = self._configuration.node, WAITING, ""
        values: dict[str, object] = {}
        sentences = self._report(session)
        if estimate is None and self._target_problem:
            values["reason"] = self._target_problem
        if estimate is not None:
            self._target_problem = ""
            mode, period = estimate.mode.value, session.tracker.frame_period
            self.localisation.locate(estimate, header, frame, period)
            self._outputs.publish_estimate(header, estimate, own, self.localisation, period)
            words = self.localisation.words
            self.health.road = self.localisation.values
            sentences += self._doubts(header, frame, estimate)
            values = {**estimate.scalars(), **self.health.road}
        if own.publish.overlay:
            with self.drawing("the overlay"):
                self._outputs.publish_overlay(header, frame, mode, estimate, words)
        self.health.answered(mode, estimate.duration * 1e3 if estimate else None)
        if sentences:
            values["event"] = "; ".join(sentences)
        is_doubtful = estimate is not None and self._stillness.is_suspect
        self.publish_mode(header, mode, values, is_doubtful=is_doubtful)

    def _doubts(self, header: Header, frame: Frame, estimate: Estimate) -> list[str]:
        """Log what speaks against the target, and return it, a sentence each."""
        sentences = []
        if estimate.regime == START:
            self._stillness.begin(estimate.box, stamp_ns(header))
            sentences += self.doubts(frame, estimate.box)
        if estimate.mode is Mode.TRACKING:
            sentences += self._stillness.look(frame, estimate.box, stamp_ns(header))
        for sentence in sentences:
            self.log.warning(sentence)
        return sentences

    def _report(self, session: Session) -> list[str]:
        """Log what the session says of the last image, and return it, a sentence each."""
        if session.refusal:
            self.health.refuse_target(session.refusal)
        if session.recovered:
            self.note_restart()
        if session.events:
            log = self.errors if session.recovered else self.warnings
            log.say("event", "; ".join(session.events))
        return [*session.events]
