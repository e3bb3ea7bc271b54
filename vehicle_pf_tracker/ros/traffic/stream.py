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

"""One stream of images and detections, and what is published of it.

Sentences in the log, each kind of them at most every few seconds.
"""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Mapping
from typing import Any

from rclpy.node import Node
from std_msgs.msg import Header

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import REJECTED, WAITING, stamp_ns
from vehicle_pf_tracker.ros.node.diagnostics import Health
from vehicle_pf_tracker.ros.node.image_input import frame_of, read_image
from vehicle_pf_tracker.ros.traffic.messages import read_serialized_detections, read_stamp, scalars
from vehicle_pf_tracker.ros.traffic.outputs import TrafficOutputs
from vehicle_pf_tracker.ros.traffic.vehicles import Vehicles
from vehicle_pf_tracker.ros.traffic.waiting_images import WaitingImages
from vehicle_pf_tracker.trackers.session import TrackerError, unexpected
from vehicle_pf_tracker.trackers.traffic.detections import MOST_DETECTIONS, Detections
from vehicle_pf_tracker.trackers.traffic.parameters import TOPIC

_PERIOD = 5.0
"""Interval between two lines of the same kind, s."""


class Notices:
    """Writes a sentence unless one of its kind was written a moment ago.

    rclpy throttles by the line of code that logs, and so cannot tell kinds apart.

    Parameters
    ----------
    write : callable
        Writes a line.
    clock : callable
        Steady time in s.
    """

    def __init__(
        self, write: Callable[[str], object], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._write = write
        self._clock = clock
        self._last: dict[str, float] = {}

    def say(self, kind: str, sentence: str) -> None:
        """Write `sentence`, one of few kinds."""
        now = self._clock()
        if now - self._last.get(kind, -_PERIOD) >= _PERIOD:
            self._last[kind] = now
            self._write(sentence)


class TrafficStream:
    """Processing of images and detections in a configured node.

    Parameters
    ----------
    node : Node
        For its log.
    configuration : Configuration
        Of `TRAFFIC`.
    outputs : TrafficOutputs
        Where estimates go.
    health : Health
        Counts what happens.

    Attributes
    ----------
    vehicles : Vehicles
        All vehicles.
    frame_id : str or None
        Of the last image that was used; None before the first.

    Raises
    ------
    InputError
        If the network, or the file of lines and zones, cannot be used.
    """

    def __init__(
        self, node: Node, configuration: Configuration, outputs: TrafficOutputs, health: Health
    ) -> None:
        self._log = node.get_logger()
        self._notices = Notices(self._log.warning)
        self._configuration = configuration
        self._outputs = outputs
        self._health = health
        self._waiting: WaitingImages[Any] | None = None
        if configuration.tracker.detector.kind == TOPIC:
            self._waiting = WaitingImages()
        self.vehicles = Vehicles(configuration)
        self.frame_id: str | None = None

    @property
    def facts(self) -> Mapping[str, object]:
        """Values for the node's report: seed, detector, vehicles."""
        waiting = self._waiting
        detections = {} if waiting is None else {
            "images with detections": waiting.matched,
            "images without detections": waiting.missed,
            "late detections": waiting.late,
            "detections of no image": waiting.unmatched,
        }  # fmt: skip
        return {
            "seed": self.vehicles.session.tracker.seed,
            "detector": self._configuration.tracker.detector.kind,
            **self.vehicles.summary(),
            **detections,
        }

    @property
    def is_waiting(self) -> bool:
        """True while an image waits for its detections."""
        return bool(self._waiting)

    def take(self, message: Any) -> None:
        """Take an image, which is answered with exactly one `~/mode`, now or after its detector."""
        if self._waiting is None:
            self._process(message, None)
            return
        max_wait = self._configuration.tracker.detector.max_wait
        self._waiting.add_image(message, stamp_ns(message.header), max_wait)
        self.go_on()

    def take_detections(self, message: bytes) -> None:
        """Take a serialized vision_msgs/Detection2DArray."""
        if self._waiting is None:
            return
        every = self._configuration.tracker.detector.every
        late, unmatched = self._waiting.late, self._waiting.unmatched
        try:
            stamp = read_stamp(message)
        except InputError as error:
            self._notices.say("flood", str(error))
            return
        self._waiting.add_detections(stamp, self._read(message), every)
        if self._waiting.late > late:
            words = "detections came after their image had waited for detector.max_wait s"
            self._notices.say("late", f"{words}, {self._waiting.late} times; they are not used")
        if self._waiting.unmatched > unmatched:
            words = f"{self._waiting.unmatched} messages of detections have the stamp of no image"
            self._notices.say("unmatched", f"{words}; the detector must copy the image's header")
        self.go_on()

    def _read(self, message: bytes) -> Detections | None:
        try:
            detections = read_serialized_detections(message)
        except InputError as error:
            self._notices.say("flood", f"{error}; vehicles are followed by their pixels meanwhile")
            return None
        if len(detections) > MOST_DETECTIONS:
            words = f"a message has {len(detections)} detections, of which the {MOST_DETECTIONS}"
            self._notices.say("flood", f"{words} of the highest scores are used")
        return detections

    def go_on(self) -> None:
        """Process the images that need not wait any longer."""
        if self._waiting is None:
            return
        missed = self._waiting.missed
        for message, detections in self._waiting.ready(self._configuration.tracker.detector.every):
            self._process(message, detections)
        if self._waiting.missed > missed:
            words = f"{self._waiting.missed} images waited in vain for detections"
            self._notices.say("missed", f"{words}; vehicles are followed by their pixels meanwhile")

    def drop_waiting(self) -> None:
        """Forget the images that wait for detections."""
        if self._waiting is not None:
            self._waiting.clear()

    def refuse(self, what: str, reason: str) -> None:
        """Report that a target or a selection cannot be used; all vehicles are kept."""
        self._health.refuse_target(reason)
        self._notices.say(what, f"{what} refused: {reason}")

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images."""
        self._configuration = configuration
        self.vehicles.reconfigure(configuration)

    def _process(self, message: Any, detections: Detections | None) -> None:
        started = time.perf_counter()
        try:
            image = read_image(message)
            events = self.vehicles.feed(image, stamp_ns(message.header), detections)
            frame = frame_of(image)
        except InputError as error:
            self._reject(message.header, str(error))
        except Exception as error:  # whatever a tracker raises
            self._fail(message.header, error)
        else:
            self.frame_id = message.header.frame_id
            self._warn_of_unusable(detections, frame)
            self._answer(message.header, frame, events, (time.perf_counter() - started) * 1e3)

    def _warn_of_unusable(self, detections: Detections | None, frame: Frame) -> None:
        if detections is None:
            return
        usable = detections.usable(*frame_size(frame))
        left_out = min(len(detections), MOST_DETECTIONS) - len(usable)
        if left_out > 0:
            words = f"{left_out} of {len(detections)} detections of an image cannot be used"
            reasons = "not finite, without an area, outside the image, or there twice"
            self._notices.say("unusable", f"{words}: {reasons}")

    def _answer(self, header: Header, frame: Frame, events: list[str], step_ms: float) -> None:
        vehicles, own = self.vehicles, self._configuration.node
        period = vehicles.session.tracker.frame_period
        estimates, selected = vehicles.estimates, vehicles.selected
        self._outputs.publish_vehicles(header, estimates, own, period)
        if vehicles.counter is not None:
            self._outputs.publish_counts(header, vehicles.counter, vehicles.latest)
        if selected is not None:
            self._outputs.publish_selected(header, selected, own, period)
        if own.publish.overlay:
            self._outputs.publish_overlay(header, frame, estimates, vehicles.counter, selected)
        mode = WAITING if selected is None else selected.mode.value
        values = {"reason": self._reason} if selected is None else scalars(selected)
        values |= {**vehicles.summary(), "step_ms": step_ms}
        self._health.restarts += vehicles.session.recovered
        for event in events:
            self._notices.say(" ".join(event.split()[:3]), event)  # without numbers
        if events:
            values["event"] = "; ".join(events)
        self._health.answered(mode, step_ms)
        self._outputs.publish_mode(header, mode, values)

    @property
    def _reason(self) -> str:
        """Reason why there is no selected vehicle in the estimates."""
        identity = self.vehicles.selection.identity
        return f"vehicle {identity} is not followed any more" if identity else "none is selected"

    def _fail(self, header: Header, error: Exception) -> None:
        """Reject an image for an unexpected error; see `Stream`."""
        self._notices.say("error", traceback.format_exc())
        self._reject(header, unexpected(error))
        if not isinstance(error, TrackerError) or error.persists:
            raise error

    def _reject(self, header: Header, reason: str) -> None:
        self._health.reject(reason)
        self._notices.say("rejected", f"image rejected: {reason}")
        self._health.answered(REJECTED)
        self._outputs.publish_mode(header, REJECTED, {"reason": reason})
