# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One stream of images and detections, and what is published of it."""

from __future__ import annotations

import time
from collections.abc import Mapping
from functools import partial

from rclpy.node import Node
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.cdr import header_stamp_ns
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.detection.detections import MOST_DETECTIONS, Detections
from vehicle_pf_tracker.detection.parameters import TOPIC
from vehicle_pf_tracker.following.detectors import PacedDetector
from vehicle_pf_tracker.image.compressed_image import CodedImage
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import WAITING, stamp_ns
from vehicle_pf_tracker.ros.node.diagnostics import Health
from vehicle_pf_tracker.ros.node.node_stream import NodeStream
from vehicle_pf_tracker.ros.node.outputs import in_pixels
from vehicle_pf_tracker.ros.own_files import own_file, write_private
from vehicle_pf_tracker.ros.traffic import messages
from vehicle_pf_tracker.ros.traffic.outputs import TrafficOutputs
from vehicle_pf_tracker.ros.traffic.vehicles import Vehicles
from vehicle_pf_tracker.ros.traffic.waiting_images import WaitingImages
from vehicle_pf_tracker.showing.live_page import LivePage
from vehicle_pf_tracker.trackers.registry import TRAFFIC
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

_BY_PIXELS = "vehicles are followed by their pixels meanwhile"


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
    page : LivePage or None
        Page that shows them; whoever ends the stream closes it.

    Raises
    ------
    InputError
        If the network, or the file of lines and zones, cannot be used.
    """

    def __init__(
        self, node: Node, configuration: Configuration, outputs: TrafficOutputs, health: Health
    ) -> None:
        self.vehicles = Vehicles(configuration)
        super().__init__(node, configuration, outputs, health)
        self._outputs = outputs
        self._awaits_detections = configuration.tracker.detector.kind == TOPIC
        self._waiting: WaitingImages[Image | CompressedImage] = WaitingImages()
        self._began = 0.0
        self._detections: Detections | None = None
        self._events: list[str] = []
        self.tell_drawn_seed(self.vehicles.session.tracker.seed)
        port = configuration.tracker.page_port
        self.page: LivePage | None = None
        if port >= 0:
            self._open_page(node, port)

    def _open_page(self, node: Node, port: int) -> None:
        """Serve the page; a port that cannot be had costs the page only."""
        try:
            self.page = LivePage(port)
        except InputError as error:
            self.log.error(f"{error}; all vehicles are followed without the page")
        else:
            self._tell_address(node.get_fully_qualified_name(), self.page.url)

    def _tell_address(self, node: str, url: str) -> None:
        """Say where the address of the page is: logs and /rosout are read by others too."""
        path = own_file(node, "page.url")
        try:
            write_private(path, f"{url}\n")
        except OSError as error:
            words = f"its address cannot be written to {path}: {error.strerror or error}"
            self.log.error(f"picture and counts are on a page, but {words}")
            return
        self.log.info(f"picture and counts are at the address in {path}, which only you can read")

    @property
    def facts(self) -> Mapping[str, object]:
        """Values for the node's report: seed, detector, vehicles."""
        tracker, detector = self.vehicles.session.tracker, self.vehicles.session.detector
        waiting, found = self._waiting, len(self._detections or ())
        seconds = waiting.latency
        if isinstance(detector, PacedDetector):
            found, seconds = detector.found, detector.seconds
        detections = {
            "images with detections": waiting.matched,
            "images without detections": waiting.missed,
            "late detections": waiting.late,
            "detections of no image": waiting.unmatched,
        }
        return {
            "variant": TRAFFIC.name,
            "seed": tracker.seed,
            "detector": self._configuration.tracker.detector.kind,
            **self.vehicles.summary(),
            "detections of the last image": found,
            "detector's latency (ms)": round(seconds * 1e3, 2),
            "places with false alarms": tracker.cluttered_places,
            **(detections if self._awaits_detections else {}),
        }

    def take(self, message: Image | CompressedImage) -> None:
        """Take an image, which is answered with exactly one `~/mode`, now or after its detector."""
        if not self._awaits_detections:
            self.process(message)
            return
        max_wait = self._configuration.tracker.detector.max_wait
        self._waiting.add_image(message, stamp_ns(message.header), max_wait)
        self.go_on()

    def take_detections(self, message: bytes) -> None:
        """Take a serialized vision_msgs/Detection2DArray."""
        every = self._configuration.tracker.detector.every
        late, unmatched = self._waiting.late, self._waiting.unmatched
        stamp = header_stamp_ns(message)
        if stamp is None:
            self.warnings.say("flood", "a message of detections is cut off before its stamp")
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
            detections = messages.read_serialized_detections(message)
        except InputError as error:
            self.warnings.say("flood", f"{error}; {_BY_PIXELS}")
            return None
        if len(detections) > MOST_DETECTIONS:
            words = f"a message has {len(detections)} detections, of which the {MOST_DETECTIONS}"
            self.warnings.say("flood", f"{words} of the highest scores are used")
        return detections

    def go_on(self) -> bool:
        """Process the images that need not wait any longer; True while others wait."""
        missed = self._waiting.missed
        for message, detections in self._waiting.ready(self._configuration.tracker.detector.every):
            self.process(message, detections)
        if self._waiting.missed > missed:
            words = f"{self._waiting.missed} images waited in vain for detections"
            self.warnings.say("missed", f"{words}; {_BY_PIXELS}")
        return bool(self._waiting)

    def drop_waiting(self) -> None:
        """Forget the images that wait for detections."""
        self._waiting.clear()

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height of the stream's images, px; None before the first."""
        return self.vehicles.session.size

    @property
    def followed(self) -> Box | None:
        """Box of the selected vehicle while it is visible; None where there is none."""
        one = self.vehicles.selected
        return one.box if one is not None and one.mode is TrackMode.TRACKING else None

    def start_on(self, box: Box) -> None:
        """Follow and select the vehicle in `box` of the first image."""
        self.vehicles.select_first(box)

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
        selected, there = vehicles.selected, in_pixels(header, own)
        self._outputs.publish_vehicles(header, there, vehicles, period)
        if selected is not None:
            self._outputs.publish_vehicle(there, selected, own, period)
        self._show(header, frame)
        chosen, mode = vehicles.selection.identity, WAITING
        reason = f"vehicle {chosen} is not followed any more" if chosen else "none is selected"
        values: dict[str, object] = {"reason": reason}
        if selected is not None:
            mode, values = selected.mode.value, messages.scalars(selected)
        values |= {**vehicles.summary(), "step_ms": step_ms}
        if vehicles.session.recovered:
            self.note_restart()
        for event in events:
            self.warnings.say(" ".join(event.split()[:3]), event)  # without numbers
        if events:
            values["event"] = "; ".join(events)
        self.health.answered(mode, step_ms)
        self.publish_mode(header, mode, values)

    def _show(self, header: Header, frame: Frame) -> None:
        """Draw the image for those who look at it."""
        if self._configuration.node.publish.overlay:
            with self.drawing("the overlay"):
                self._outputs.publish_overlay(header, frame, self.vehicles)
        if self.page is not None:
            with self.drawing("the live page"):
                self.page.show(partial(self.vehicles.shown, frame), self.vehicles.facts)
