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

"""One stream of images and detections, and what is published of it."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Generic, TypeVar

from rclpy.node import Node
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.compressed_image import CodedImage
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import WAITING, stamp_ns
from vehicle_pf_tracker.ros.node.diagnostics import Health
from vehicle_pf_tracker.ros.node.node_stream import NodeStream
from vehicle_pf_tracker.ros.node.outputs import in_pixels
from vehicle_pf_tracker.ros.traffic.messages import read_serialized_detections, read_stamp, scalars
from vehicle_pf_tracker.ros.traffic.outputs import TrafficOutputs
from vehicle_pf_tracker.ros.traffic.vehicles import Vehicles
from vehicle_pf_tracker.trackers.registry import TRAFFIC
from vehicle_pf_tracker.trackers.traffic.detections import MOST_DETECTIONS, Detections
from vehicle_pf_tracker.trackers.traffic.parameters import TOPIC

MOST_WAITING = 16
"""Images that may wait: half a second at 30 Hz; of 1080p they are 100 MB."""
_REMEMBERED = 100
"""Images passed on whose detections are recognised as late; detections kept whose image has not
come."""

_BY_PIXELS = "vehicles are followed by their pixels meanwhile"

ImageT = TypeVar("ImageT")


@dataclass(slots=True)
class _Waiting(Generic[ImageT]):
    """An image with its number in the stream, and when it has waited for long enough, s."""

    image: ImageT
    stamp_ns: int
    number: int
    until: float
    is_answered: bool = False
    detections: Detections | None = None


class WaitingImages(Generic[ImageT]):
    """Passes on images in their order, each with its detections or without.

    An image waits for detections of exactly its stamp: until they come, those of a later image come
    (a detector answers in order), or it has waited for too long. A detector may answer every k-th
    image; the others do not wait.

    Parameters
    ----------
    clock : callable
        Steady time in s.

    Attributes
    ----------
    matched, missed, late, unmatched : int
        Images with detections, images that waited in vain, detections that came after their image
        was passed on, and detections of stamps that no image has.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.matched = self.missed = self.late = self.unmatched = 0
        self._clock = clock
        self._images: deque[_Waiting[ImageT]] = deque()
        self._early: dict[int, Detections | None] = {}
        self._passed: dict[int, int] = {}
        self._number = 0
        self._awaited = 0

    def __len__(self) -> int:
        return len(self._images)

    @property
    def remembered(self) -> int:
        """Number of stamps that are kept without an image: of early and of late detections."""
        return len(self._early) + len(self._passed)

    def add_image(self, image: ImageT, stamp_ns: int, max_wait: float) -> None:
        """Take the next image, which may wait for `max_wait` s."""
        waiting = _Waiting(image, stamp_ns, self._number, self._clock() + max_wait)
        if stamp_ns in self._early:
            waiting.is_answered, waiting.detections = True, self._early.pop(stamp_ns)
        self._number += 1
        self._images.append(waiting)

    def add_detections(self, stamp_ns: int, detections: Detections | None, every: int = 1) -> None:
        """Take the detections of an image; None: the answer cannot be used.

        The detector answers every `every`-th image.
        """
        for waiting in self._images:
            if waiting.stamp_ns == stamp_ns and not waiting.is_answered:
                waiting.is_answered, waiting.detections = True, detections
                return
        if stamp_ns in self._passed:
            self.late += 1
            self._awaited = self._passed.pop(stamp_ns) + every
            return
        self._early[stamp_ns] = detections
        if len(self._early) > _REMEMBERED:
            del self._early[next(iter(self._early))]
            self.unmatched += 1

    def ready(self, every: int = 1) -> Iterator[tuple[ImageT, Detections | None]]:
        """Pass on the images that need not wait any longer."""
        while self._images:
            first = self._images[0]
            if not first.is_answered and self._waits(first):
                return
            self._images.popleft()
            if first.is_answered:
                self.matched += 1
                self._awaited = first.number + every
            else:
                self.missed += first.number >= self._awaited
                self._remember(first)
            yield first.image, first.detections

    def clear(self) -> None:
        """Forget all images and detections."""
        self._images.clear()
        self._early.clear()
        self._passed.clear()

    def _waits(self, first: _Waiting[ImageT]) -> bool:
        return (
            first.number >= self._awaited
            and self._clock() < first.until
            and len(self._images) <= MOST_WAITING
            and not any(one.is_answered for one in self._images)
        )

    def _remember(self, passed: _Waiting[ImageT]) -> None:
        self._passed[passed.stamp_ns] = passed.number
        if len(self._passed) > _REMEMBERED:
            del self._passed[next(iter(self._passed))]


class TrafficStream(NodeStream):
    """Processing of images and detections in a configured node.

    Parameters
    ----------
    node : Node
        For its log.
    configuration : Configuration
        Parameters of `TRAFFIC`.
    outputs : TrafficOutputs
        Publishers of the estimates.
    health : Health
        Counts what happens.

    Attributes
    ----------
    vehicles : Vehicles
        All vehicles.

    Raises
    ------
    InputError
        If the network, or the file of lines and zones, cannot be used.
    """

    def __init__(
        self, node: Node, configuration: Configuration, outputs: TrafficOutputs, health: Health
    ) -> None:
        super().__init__(node, configuration, outputs, health)
        self._outputs = outputs
        self._waiting: WaitingImages[Image | CompressedImage] | None = None
        if configuration.tracker.detector.kind == TOPIC:
            self._waiting = WaitingImages()
        self.vehicles = Vehicles(configuration)
        self._began = 0.0
        self._detections: Detections | None = None
        self._events: list[str] = []
        self.tell_drawn_seed(self.vehicles.session.tracker.seed)

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
            "variant": TRAFFIC.name,
            "seed": self.vehicles.session.tracker.seed,
            "detector": self._configuration.tracker.detector.kind,
            **self.vehicles.summary(),
            **detections,
        }

    @property
    def is_waiting(self) -> bool:
        """True while an image waits for its detections."""
        return bool(self._waiting)

    def take(self, message: Image | CompressedImage) -> None:
        """Take an image, which is answered with exactly one `~/mode`, now or after its detector."""
        if self._waiting is None:
            self.process(message)
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
            self.warnings.say("flood", str(error))
            return
        self._waiting.add_detections(stamp, self._read(message), every)
        if self._waiting.late > late:
            words = "detections came after their image had waited for detector.max_wait s"
            self.warnings.say("late", f"{words}, {self._waiting.late} times; they are not used")
        if self._waiting.unmatched > unmatched:
            words = f"{self._waiting.unmatched} messages of detections have the stamp of no image"
            self.warnings.say("unmatched", f"{words}; the detector must copy the image's header")
        self.go_on()

    def _read(self, message: bytes) -> Detections | None:
        try:
            detections = read_serialized_detections(message)
        except InputError as error:
            self.warnings.say("flood", f"{error}; {_BY_PIXELS}")
            return None
        if len(detections) > MOST_DETECTIONS:
            words = f"a message has {len(detections)} detections, of which the {MOST_DETECTIONS}"
            self.warnings.say("flood", f"{words} of the highest scores are used")
        return detections

    def go_on(self) -> None:
        """Process the images that need not wait any longer."""
        if self._waiting is None:
            return
        missed = self._waiting.missed
        for message, detections in self._waiting.ready(self._configuration.tracker.detector.every):
            self.process(message, detections)
        if self._waiting.missed > missed:
            words = f"{self._waiting.missed} images waited in vain for detections"
            self.warnings.say("missed", f"{words}; {_BY_PIXELS}")

    def drop_waiting(self) -> None:
        """Forget the images that wait for detections."""
        if self._waiting is not None:
            self._waiting.clear()

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height of the stream's images, px; None before the first."""
        return self.vehicles.session.size

    def reset(self) -> str:
        """Forget all vehicles and counts; begin on the configured target."""
        self.vehicles.reset()
        return "all vehicles are forgotten"

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images."""
        tracker = self.vehicles.session.tracker
        before, self._configuration = tracker.seed, configuration
        self.vehicles.reconfigure(configuration)
        if tracker.seed != before:
            self.tell_drawn_seed(tracker.seed)

    def feed(self, image: Frame | CodedImage, stamp_ns: int, extra: Detections | None) -> None:
        """Feed an image with its detections; None of an image without."""
        self._began, self._detections = time.perf_counter(), extra
        self._events = self.vehicles.feed(image, stamp_ns, extra)

    def _warn_of_unusable(self, detections: Detections | None, frame: Frame) -> None:
        if detections is None:
            return
        usable = detections.usable(*frame_size(frame))
        left_out = min(len(detections), MOST_DETECTIONS) - len(usable)
        if left_out > 0:
            words = f"{left_out} of {len(detections)} detections of an image cannot be used"
            reasons = "not finite, without an area, outside the image, or there twice"
            self.warnings.say("unusable", f"{words}: {reasons}")

    def answer(self, header: Header, frame: Frame) -> None:
        """Publish all vehicles of the last image, the selected one, and its mode."""
        self._warn_of_unusable(self._detections, frame)
        step_ms = (time.perf_counter() - self._began) * 1e3
        vehicles, own, events = self.vehicles, self._configuration.node, self._events
        while vehicles.given:
            events += self.doubts(frame, vehicles.given.pop())
        period = vehicles.session.tracker.frame_period
        estimates, selected = vehicles.estimates, vehicles.selected
        self._outputs.publish_vehicles(header, estimates, own, period)
        if vehicles.counter is not None:
            self._outputs.publish_counts(header, vehicles.counter, vehicles.latest)
        if selected is not None:
            self._outputs.publish_vehicle(in_pixels(header, own), selected, own, period)
        if own.publish.overlay:
            self._outputs.publish_overlay(header, frame, estimates, vehicles.counter, selected)
        mode = WAITING if selected is None else selected.mode.value
        values = {"reason": self._reason} if selected is None else scalars(selected)
        values |= {**vehicles.summary(), "step_ms": step_ms}
        self.health.restarts += vehicles.session.recovered
        for event in events:
            self.warnings.say(" ".join(event.split()[:3]), event)  # without numbers
        if events:
            values["event"] = "; ".join(events)
        self.health.answered(mode, step_ms)
        self.publish_mode(header, mode, values)

    @property
    def _reason(self) -> str:
        """Reason why there is no selected vehicle in the estimates."""
        identity = self.vehicles.selection.identity
        return f"vehicle {identity} is not followed any more" if identity else "none is selected"
