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

"""One stream of images through a session, and what is published of it."""

from __future__ import annotations

import traceback
from collections.abc import Mapping

from rclpy.node import Node
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.encodings import MAX_SIDE
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import REJECTED, WAITING, stamp_ns
from vehicle_pf_tracker.ros.node.camera_inputs import StreamLocalisation
from vehicle_pf_tracker.ros.node.diagnostics import Health
from vehicle_pf_tracker.ros.node.image_input import SerializedImage, frame_of, read_image
from vehicle_pf_tracker.ros.node.kernel_loading import KernelLoading
from vehicle_pf_tracker.ros.node.outputs import Outputs
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.trackers.session import Session, TargetError, TrackerError, unexpected

_THROTTLE = 5.0
"""Interval between two lines of the same kind in the log, s."""


class Stream:
    """Processing of images and targets in a configured node.

    Parameters
    ----------
    node : Node
        For its log.
    variant : Variant
        From the registry.
    configuration : Configuration
        Of this variant.
    outputs : Outputs
        Where estimates go.
    health : Health
        Counts what happens.

    Attributes
    ----------
    asked : Box or None
        Target that the next image starts on; None where none was given.
    frame_id : str or None
        Of the last image that was used; None before the first.
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
        outputs: Outputs,
        health: Health,
    ) -> None:
        self._log = node.get_logger()
        self._outputs = outputs
        self._health = health
        self._variant = variant
        self._configuration = configuration
        self._applied = configuration
        self._session: Session | None = None
        self._loading = KernelLoading(configuration.tracker.kernels)
        self.asked: Box | None = None
        self._target_problem = ""
        self.localisation = StreamLocalisation(variant.name, configuration.session.road)
        self.frame_id: str | None = None
        self.estimate: Estimate | None = None
        if not self.get_ready():
            self._log.info(self._loading.reason)

    def get_ready(self) -> bool:
        """Make the session, and take new parameters, as soon as their kernels are loaded.

        Returns
        -------
        bool
            Whether images can be tracked in.
        """
        if self._loading.is_done:
            if self._session is None:
                self._begin()
            elif self._applied is not self._configuration:
                self._apply(self._session)
        return self._session is not None

    @property
    def facts(self) -> Mapping[str, object]:
        """Choices that the parameters leave open: the seed and the kernels in use."""
        if self._session is None:
            return {"seed": self._configuration.tracker.seed, "kernels": self._loading.reason}
        tracker = self._session.tracker
        return {"seed": tracker.seed, "kernels": tracker.kernels.name}

    @property
    def target_words(self) -> str:
        """Description of the next target, for people."""
        box = self._configuration.session.target.box
        return f"following {box}" if box else "waiting for a target on ~/set_target"

    @property
    def box(self) -> Box | None:
        """The present box: that of the estimate, else the configured one."""
        return self.estimate.box if self.estimate else self._configuration.session.target.box

    def take(self, message: Image | SerializedImage | CompressedImage) -> None:
        """Answer an image with exactly one `~/mode`, and with an estimate where there is one."""
        if not self.get_ready() or self._session is None:
            self._wait(message.header, self._loading.reason)
            return
        if self.asked is not None:
            self._session.set_target(self.asked)
            self.asked = None
        try:
            image = read_image(message)
            self.estimate = self._session.feed(image, stamp_ns(message.header))
            frame = frame_of(image)
        except TargetError as error:
            self._wait(message.header, str(error))
        except InputError as error:
            self._reject(message.header, str(error))
        except Exception as error:  # whatever a tracker raises
            self._fail(message.header, error)
        else:
            self.frame_id = message.header.frame_id
            self._answer(self._session, message.header, frame, self.estimate)

    def set_target(self, box: Box) -> None:
        """Start on `box` with the next image, if it fits into that.

        Raises
        ------
        InputError
            If it is no box in any image.
        """
        self.asked = check_target(box, MAX_SIDE, MAX_SIDE)

    def refuse_target(self, reason: str) -> None:
        """Report that a target cannot be used; the track continues."""
        self._health.refuse_target(reason)
        self._log.error(f"target refused: {reason}", throttle_duration_sec=_THROTTLE)

    def reset(self) -> None:
        """Go back to the configured target, or to waiting for one.

        Raises
        ------
        InputError
            If the kernels are not loaded yet, or the configured target is outside the images, so
            that the next ones will not be tracked in.
        """
        if not self.get_ready() or self._session is None:
            raise InputError(self._loading.reason)
        size = self._session.size
        self.asked = self.estimate = None
        self._session.reset()
        self._target_problem = self._misfit(self._configuration, size)
        if self._target_problem:
            raise InputError(f"{self._target_problem}; waiting for a target")

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images, or when their kernels are loaded."""
        if configuration.session.target != self._configuration.session.target:
            self._target_problem = ""
        if configuration.session.road != self._configuration.session.road:
            self.localisation.reconfigure(configuration.session.road)
        self._configuration = configuration
        if configuration.tracker.kernels != self._loading.choice:
            self._loading = KernelLoading(configuration.tracker.kernels)
        self.get_ready()

    def _begin(self) -> None:
        self._applied = self._configuration
        self._session = Session(
            self._variant, self._configuration.tracker, self._configuration.session
        )
        self._tell_drawn_seed(self._session)
        for notice in self._session.tracker.kernels.notices:
            self._log.warning(notice)

    def _apply(self, session: Session) -> None:
        before = session.tracker.seed
        self._applied = self._configuration
        session.reconfigure(self._configuration.tracker, self._configuration.session)
        if session.tracker.seed != before:
            self._tell_drawn_seed(session)

    def check(self, configuration: Configuration) -> None:
        """Refuse a configuration with a new target that is outside the stream's images.

        Raises
        ------
        InputError
            With the reason.
        """
        is_new = configuration.session.target != self._configuration.session.target
        problem = self._misfit(configuration, self._session.size if self._session else None)
        if is_new and problem:
            raise InputError(problem)

    @staticmethod
    def _misfit(configuration: Configuration, size: tuple[int, int] | None) -> str:
        """Say why images of this size cannot be started in on the configured target, if so."""
        box = configuration.session.target.box
        if box is None or size is None:
            return ""
        try:
            check_target(box, *size)
        except InputError as error:
            return str(error)
        return ""

    def _wait(self, header: Header, reason: str) -> None:
        """Answer an image in which nothing can be tracked, for this reason."""
        if reason not in (self._loading.reason, self._target_problem):
            self.refuse_target(reason)
            self._target_problem = reason
        self._health.answered(WAITING)
        self._outputs.publish_mode(header, WAITING, {"reason": reason})

    def _answer(
        self, session: Session, header: Header, frame: Frame, estimate: Estimate | None
    ) -> None:
        if session.refusal:
            self._health.refuse_target(session.refusal)
        events = self._events(session)
        if estimate is None and self._target_problem:
            events["reason"] = self._target_problem
        mode = estimate.mode.value if estimate is not None else WAITING
        own, words = self._configuration.node, ""
        if estimate is not None:
            self._target_problem = ""
            period = session.tracker.frame_period
            self.localisation.locate(estimate, header, frame, period)
            self._outputs.publish_estimate(header, estimate, own, self.localisation, period)
            words = self.localisation.words
            self._health.road = self.localisation.values
            events |= self._health.road
        if own.publish.overlay:
            self._outputs.publish_overlay(header, frame, mode, estimate, words)
        self._health.answered(mode, estimate.duration * 1e3 if estimate else None)
        self._outputs.publish_mode(header, mode, events, estimate)

    def _reject(self, header: Header, reason: str) -> None:
        self._health.reject(reason)
        self._log.error(f"image rejected: {reason}", throttle_duration_sec=_THROTTLE)
        self._health.answered(REJECTED)
        self._outputs.publish_mode(header, REJECTED, {"reason": reason})

    def _fail(self, header: Header, error: Exception) -> None:
        """Reject an image for an unexpected error, and raise it unless it concerns this image only.

        One image must not end a node that others rely on; a broken tracker must.
        """
        self._log.error(traceback.format_exc(), throttle_duration_sec=_THROTTLE)
        self._reject(header, unexpected(error))
        if not isinstance(error, TrackerError) or error.persists:
            raise error

    def _events(self, session: Session) -> dict[str, object]:
        words = "; ".join(session.events)
        if not words:
            return {}
        if session.recovered:
            self._health.restarts += 1
            self._log.error(words, throttle_duration_sec=_THROTTLE)
        else:
            self._log.warning(words, throttle_duration_sec=_THROTTLE)
        return {"event": words}

    def _tell_drawn_seed(self, session: Session) -> None:
        if self._configuration.tracker.seed < 0:
            self._log.info(f"drew the seed {session.tracker.seed}; set it to repeat this run")
