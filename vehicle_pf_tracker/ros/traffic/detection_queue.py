# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images on their way through a node that wait for the detections of their stamp."""

from __future__ import annotations

from collections.abc import Callable

from vehicle_pf_tracker.core.cdr import header_stamp_ns
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.detections import MOST_DETECTIONS, Detections
from vehicle_pf_tracker.detection.parameters import DetectorParameters
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.ros.node.notices import Notices
from vehicle_pf_tracker.ros.serialized_image import ImageMessage
from vehicle_pf_tracker.ros.traffic.messages import read_serialized_detections
from vehicle_pf_tracker.ros.traffic.waiting_images import WaitingImages

_BY_PIXELS = "vehicles are followed by their pixels meanwhile"
"""Consequence of missing detections, for the log."""

WaitingMessages = WaitingImages[ImageMessage]


class DetectionQueue:
    """Passes images on, each with its detections or without, and says what is missing.

    Parameters
    ----------
    waiting : WaitingImages
        The images and detections themselves.
    parameters : callable
        Returns those of the detector.
    pass_on : callable
        Takes an image and its detections.
    warnings : Notices
        Lines in the log.
    """

    def __init__(
        self,
        waiting: WaitingMessages,
        parameters: Callable[[], DetectorParameters],
        pass_on: Callable[[ImageMessage, Detections | None], None],
        warnings: Notices,
    ) -> None:
        self._waiting = waiting
        self._parameters = parameters
        self._pass_on = pass_on
        self._warnings = warnings

    def add_image(self, message: ImageMessage) -> None:
        """Take an image, which is passed on now or after its detections."""
        self._waiting.add_image(message, stamp_ns(message.header), self._parameters().max_wait)
        self.go_on()

    def add_detections(self, message: bytes) -> None:
        """Take a serialized vision_msgs/Detection2DArray."""
        waiting = self._waiting
        late = waiting.late
        unmatched = waiting.unmatched
        stamp = header_stamp_ns(message)
        if stamp is None:
            self._warnings.say("flood", "a message of detections is cut off before its stamp")
            return
        waiting.add_detections(stamp, self._read(message), self._parameters().every)
        if waiting.late > late:
            words = "detections came after their image had waited for detector.max_wait s"
            self._warnings.say("late", f"{words}, {waiting.late} times; they are not used")
        if waiting.unmatched > unmatched:
            words = f"{waiting.unmatched} messages of detections have the stamp of no image"
            self._warnings.say("unmatched", f"{words}; the detector must copy the image's header")
        self.go_on()

    def go_on(self) -> bool:
        """Pass on the images that need not wait any longer; True while others wait."""
        missed = self._waiting.missed
        for message, detections in self._waiting.ready(self._parameters().every):
            self._pass_on(message, detections)
        if self._waiting.missed > missed:
            words = f"{self._waiting.missed} images waited in vain for detections"
            self._warnings.say("missed", f"{words}; {_BY_PIXELS}")
        return bool(self._waiting)

    def clear(self) -> None:
        """Forget the images that wait, and the detections."""
        self._waiting.clear()

    def _read(self, message: bytes) -> Detections | None:
        try:
            detections = read_serialized_detections(message)
        except InputError as error:
            self._warnings.say("flood", f"{error}; {_BY_PIXELS}")
            return None
        if len(detections) > MOST_DETECTIONS:
            words = f"a message has {len(detections)} detections, of which the {MOST_DETECTIONS}"
            self._warnings.say("flood", f"{words} of the highest scores are used")
        return detections
