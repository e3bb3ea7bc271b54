"""One stream of images through a session, and what is published of it."""

from __future__ import annotations

import traceback
from collections.abc import Mapping

from rclpy.node import Node
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.encodings import MAX_SIDE
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import REJECTED, WAITING, stamp_ns
from vehicle_pf_tracker.ros.node.health import Health
from vehicle_pf_tracker.ros.node.images import SerializedImage, read_image
from vehicle_pf_tracker.ros.node.outputs import Outputs
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.trackers.session import Session

_THROTTLE = 5.0
"""Seconds between two lines of the same kind in the log."""


class Stream:
    """What a configured node does with images and targets.

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
    frame_id : str or None
        Of the last image that was used; None before the first.
    estimate : Estimate or None
        The last one; None while there is no target.
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
        self._configuration = configuration
        if configuration.tracker.kernels != "opencv":
            self._log.info("loading kernels; the first start compiles them, for some seconds")
        self._session = Session(variant, configuration.tracker, configuration.session)
        self._asked: Box | None = None
        self.frame_id: str | None = None
        self.estimate: Estimate | None = None
        self._tell_drawn_seed()
        for notice in self._session.tracker.kernels.notices:
            self._log.warning(notice)

    @property
    def seed(self) -> int:
        """The seed in use."""
        return self._session.tracker.seed

    @property
    def facts(self) -> Mapping[str, object]:
        """What the parameters left open: the seed and the kernels in use."""
        return {"seed": self.seed, "kernels": self._session.tracker.kernels.name}

    @property
    def target_words(self) -> str:
        """What will be followed, for people."""
        box = self._configuration.session.target.box
        return f"following {box}" if box else "waiting for a target on ~/set_target"

    @property
    def box(self) -> Box | None:
        """The present box: that of the estimate, else the configured one."""
        return self.estimate.box if self.estimate else self._configuration.session.target.box

    def take(self, message: Image | SerializedImage | CompressedImage) -> None:
        """Answer an image with exactly one `~/mode`, and with an estimate where there is one."""
        try:
            frame = read_image(message)
            self._adopt_target(frame)
            self.estimate = self._session.feed(frame, stamp_ns(message.header))
        except InputError as error:
            self._reject(message.header, str(error))
        except Exception as error:  # an image must not end a node that others rely on
            self._log.error(traceback.format_exc(), throttle_duration_sec=_THROTTLE)
            self._reject(message.header, f"unexpected {type(error).__name__}: {error}")
        else:
            self.frame_id = message.header.frame_id
            self._answer(message.header, frame, self.estimate)

    def set_target(self, box: Box) -> None:
        """Start on `box` with the next image, if it fits into that.

        Raises
        ------
        InputError
            If it is no box in any image.
        """
        self._asked = check_target(box, MAX_SIDE, MAX_SIDE)

    def refuse_target(self, reason: str) -> None:
        """Say that a target cannot be used; the track goes on."""
        self._health.refuse_target(reason)
        self._log.error(f"target refused: {reason}", throttle_duration_sec=_THROTTLE)

    def reset(self) -> None:
        """Go back to the configured target, or to waiting for one."""
        self._asked = self.estimate = None
        self._session.reset()

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images."""
        self._configuration = configuration
        before = self.seed
        self._session.reconfigure(configuration.tracker, configuration.session)
        if self.seed != before:
            self._tell_drawn_seed()

    def _adopt_target(self, frame: Frame) -> None:
        # Checked here and not by the session, which would give up this image's estimate for it;
        # and not in an image of another size, which may be a stray.
        size = frame_size(frame)
        if self._asked is None or self._session.size not in (None, size):
            return
        box, self._asked = self._asked, None
        try:
            self._session.set_target(check_target(box, *size))
        except InputError as error:
            self.refuse_target(str(error))

    def _answer(self, header: Header, frame: Frame, estimate: Estimate | None) -> None:
        events = self._events()
        mode = estimate.mode.value if estimate is not None else WAITING
        switches = self._configuration.node.publish
        if estimate is not None:
            period = self._session.tracker.frame_period
            self._outputs.publish_estimate(header, estimate, switches, period)
        if switches.overlay:
            self._outputs.publish_overlay(header, frame, mode, estimate)
        self._health.answered(mode, estimate.duration * 1e3 if estimate else None)
        self._outputs.publish_mode(header, mode, events, estimate)

    def _reject(self, header: Header, reason: str) -> None:
        self._health.reject(reason)
        self._log.error(f"image rejected: {reason}", throttle_duration_sec=_THROTTLE)
        self._health.answered(REJECTED)
        self._outputs.publish_mode(header, REJECTED, {"reason": reason})

    def _events(self) -> dict[str, object]:
        words = "; ".join(self._session.events)
        if not words:
            return {}
        self._log.warning(words, throttle_duration_sec=_THROTTLE)
        return {"event": words}

    def _tell_drawn_seed(self) -> None:
        if self._configuration.tracker.seed < 0:
            self._log.info(f"drew the seed {self.seed}; set it to repeat this run")
