# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The node that follows many vehicles: images and detections in, tracks out."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import PointStamped
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from sensor_msgs.msg import RegionOfInterest
from std_msgs.msg import Int64

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.parameters import TOPIC_DETECTOR
from vehicle_pf_tracker.following.networks.model_files import is_fetched
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.image_memory import return_memory
from vehicle_pf_tracker.ros.messages import detections_type
from vehicle_pf_tracker.ros.node.image_input import image_topic, subscribe
from vehicle_pf_tracker.ros.node.image_node import ImageNode
from vehicle_pf_tracker.ros.node.image_path import ImagePath
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.target_messages import box_of_region, finite
from vehicle_pf_tracker.ros.traffic.detection_queue import DetectionQueue, WaitingMessages
from vehicle_pf_tracker.ros.traffic.live_page import open_page
from vehicle_pf_tracker.ros.traffic.messages import LONGEST_MESSAGE
from vehicle_pf_tracker.ros.traffic.outputs import TrafficOutputs
from vehicle_pf_tracker.ros.traffic.traffic_feed import TrafficFeed
from vehicle_pf_tracker.ros.traffic.vehicles import Vehicles
from vehicle_pf_tracker.ros.traffic.waiting_images import MOST_WAITING
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT

_WAITING_PERIOD = 0.02
"""Interval in s at which images that have waited for detections for long enough are passed on: the
least `max_wait` that is of use is a period of the images, 33 ms at 30 Hz."""
_RENEWED_AFTER = 5.0
"""Time in s after a flood of detections until the subscription to them is made anew, as a detector
that floods once floods again: the new one misses what comes until it is matched."""


class TrafficNode(ImageNode):
    """Managed node `traffic_tracker`; active at once unless the parameter `autostart` is false.

    Parameters
    ----------
    **options
        Passed on to `rclpy.node.Node`.

    Attributes
    ----------
    feed : TrafficFeed or None
        All vehicles; None while the node is not configured.

    Raises
    ------
    InputError
        If a parameter or a QoS override does not fit.
    """

    feed: TrafficFeed | None

    def __init__(self, **options: Any) -> None:
        super().__init__(TRAFFIC_VARIANT.executable, **options)
        self._queue: DetectionQueue | None = None
        self._detections: Subscription | None = None
        self.begin(Configuration.of(TRAFFIC_VARIANT))

    def prepare(self) -> None:
        """Make session, detector, outputs and services."""
        configuration = self.table.configuration
        if configuration.tracker.detector.kind == TOPIC_DETECTOR and detections_type() is None:
            raise InputError(
                "detector.kind is topic, and vision_msgs, which detections come in, is not "
                "installed (apt: ros-<release>-vision-msgs)"
            )
        if is_fetched(configuration.tracker.detector.model):
            self.get_logger().info("fetching the network, unless it is in the cache")
        journal = Journal(self, self.diagnostics.begin())
        waiting = WaitingMessages()
        self.feed = TrafficFeed(configuration, waiting, journal)
        self.outputs = self._open_outputs(configuration, self.feed.vehicles, journal)
        self.path = ImagePath(self, configuration, self.feed, self.outputs, journal)
        self.accept = self.path.take
        self._queue = None
        if configuration.tracker.detector.kind == TOPIC_DETECTOR:
            self._queue = DetectionQueue(
                waiting,
                lambda: self.table.configuration.tracker.detector,
                self.path.take,
                journal.warnings,
            )
            self.accept = self._await_detections
        self._waiting_timer = self.poll(_WAITING_PERIOD, self._pass_on_waiting)
        self._renewal_timer = self.poll(_RENEWED_AFTER, self._renew_detections)
        for timer in (self._waiting_timer, self._renewal_timer):
            timer.cancel()
        self.serve("~/remove_selected", self._remove)

    def _open_outputs(
        self, configuration: Configuration, vehicles: Vehicles, journal: Journal
    ) -> TrafficOutputs:
        """Open publishers and page; a clean-up closes them."""
        page = None
        port = configuration.tracker.page_port
        if port >= 0:
            page = open_page(self.get_fully_qualified_name(), port, journal)
        if page is not None:
            self.held.callback(page.close)
        topic = image_topic(self, configuration.node.image_transport)
        outputs = TrafficOutputs(self, topic, vehicles, page, journal)
        self.held.callback(outputs.close)
        return outputs

    def activate(self) -> None:
        """Open the inputs."""
        source = self.open_images()
        self.listen(RegionOfInterest, "~/add_target", "target", self._add)
        self.listen(PointStamped, "~/clicked_point", "selection", self._choose_at)
        self.listen(Int64, "~/select", "selection", self._choose)
        detector = self.table.configuration.tracker.detector.kind
        if detector == TOPIC_DETECTOR:
            self._listen_to_detections()
        self.warn_of_overrides(qos=True)
        self.get_logger().info(f"ready: images on {source}, detections: {detector}")

    def deactivate(self) -> None:
        """Close the inputs."""
        super().deactivate()
        if self.feed is not None:
            self._waiting_timer.cancel()
        if self.feed is not None and self._queue is not None:
            self._queue.clear()

    def _await_detections(self, image: Any) -> None:
        """Let an image wait for its detections."""
        assert self._queue is not None
        self._queue.add_image(image)
        # Without an image that waits, a timer of 50 Hz would take a fortieth of a processor.
        if self._waiting_timer.is_canceled():
            self._waiting_timer.reset()

    def _pass_on_waiting(self) -> None:
        if self.feed is None or self._queue is None or not self._queue.go_on():
            self._waiting_timer.cancel()

    def _listen_to_detections(self) -> None:
        # As many as images may wait: a detector may answer several at once.
        qos = QoSProfile(depth=MOST_WAITING)
        topic = self.resolve_topic_name("detections")
        take = self._on_detections
        self._detections = subscribe(self, detections_type(), topic, take, qos, raw=True)
        self.inputs.append(self._detections)

    def _on_detections(self, message: bytes) -> None:
        if self.feed is None or self._queue is None:
            return
        if len(message) > LONGEST_MESSAGE and self._renewal_timer.is_canceled():
            self._renewal_timer.reset()
        self._queue.add_detections(message)

    def _renew_detections(self) -> None:
        """Free what a flood took: Fast DDS keeps each of a reader's buffers at its longest."""
        self._renewal_timer.cancel()
        if self._detections in self.inputs:  # still active
            self.inputs.remove(self._detections)
            self.destroy_subscription(self._detections)
            self._listen_to_detections()
        return_memory()

    def _add(self, message: RegionOfInterest, _: ImagePath) -> None:
        box = box_of_region(message)
        identity = self._vehicles.add(box)
        if identity is not None:
            self.get_logger().info(f"following {box} as {identity}")

    def _choose_at(self, message: PointStamped, path: ImagePath) -> None:
        path.check_frame_id("~/clicked_point", message.header)
        x, y = finite("~/clicked_point", message.point.x, message.point.y)
        vehicles = self._vehicles
        vehicles.selection.choose_at((x, y), vehicles.estimates)

    def _choose(self, message: Int64, _: ImagePath) -> None:
        vehicles = self._vehicles
        vehicles.selection.choose(message.data, vehicles.estimates)

    def _remove(self) -> str:
        return f"vehicle {self._vehicles.remove_selected()} is forgotten"

    @property
    def _vehicles(self) -> Vehicles:
        assert self.feed is not None
        return self.feed.vehicles

    def _check(self, configuration: Configuration) -> None:
        configuration.session.road.fixed_plane()
        super()._check(configuration)
