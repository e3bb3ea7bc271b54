# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracker node: images in, estimates out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import PointStamped, PolygonStamped
from sensor_msgs.msg import RegionOfInterest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros import target_messages
from vehicle_pf_tracker.ros.messages import detection_type
from vehicle_pf_tracker.ros.node.camera_inputs import CameraInputs
from vehicle_pf_tracker.ros.node.image_input import image_topic
from vehicle_pf_tracker.ros.node.image_node import ImageNode
from vehicle_pf_tracker.ros.node.image_path import ImagePath
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.node.stream_localisation import StreamLocalisation
from vehicle_pf_tracker.ros.node.tracker_feed import TrackerFeed
from vehicle_pf_tracker.ros.node.tracker_outputs import TrackerOutputs
from vehicle_pf_tracker.trackers.registry import Variant

_POLL = 0.1
"""Interval of the check for loaded kernels while no image asks for them, s: not felt by who waits
for the word `ready`."""


class TrackerNode(ImageNode):
    """Managed node of one variant; active at once unless the parameter `autostart` is false.

    Parameters
    ----------
    variant : Variant
        Variant from the registry; the node is called ``<variant>_tracker``.
    **options
        Passed on to `rclpy.node.Node`.

    Attributes
    ----------
    feed : TrackerFeed or None
        Session of the target; None while the node is not configured.

    Raises
    ------
    InputError
        If a parameter or a QoS override does not fit.
    """

    feed: TrackerFeed | None

    def __init__(self, variant: Variant, **options: Any) -> None:
        super().__init__(f"{variant.name}_tracker", **options)
        self._variant = variant
        self._cameras = CameraInputs(self)
        self._has_logged_ready = False
        self.begin(Configuration.of(variant))

    def prepare(self) -> None:
        """Make session, outputs and services."""
        configuration = self.table.configuration
        journal = Journal(self, self.diagnostics.begin())
        road = configuration.session.road
        localisation = StreamLocalisation(self._variant.name, road, self._cameras)
        topic = image_topic(self, configuration.node.image_transport)
        outputs = TrackerOutputs(self, topic, localisation, journal)
        # Before what may fail below: `configure` releases it then.
        self.held.callback(outputs.close)
        self.feed = TrackerFeed(self._variant, configuration, localisation, journal)
        self.path = ImagePath(self, configuration, self.feed, outputs, journal)
        self.accept = self.path.take
        self._ready_timer = self.poll(_POLL, self._await_kernels)

    def activate(self) -> None:
        """Open the inputs."""
        self.open_images()
        # Only now are the overrides of the image topic declared.
        self.warn_of_overrides(qos=True)
        self._cameras.open(self.table.configuration.session.road)
        self._take_target("~/set_target", RegionOfInterest, target_messages.box_of_region)
        self._take_target("~/set_box", PolygonStamped, target_messages.box_of_polygon)
        self._take_target("~/clicked_point", PointStamped, self._box_at)
        if (kind := detection_type()) is not None:
            self._take_target("~/set_detection", kind, target_messages.box_of_detection)
        # Once for each activation: replays and launch files wait for the word.
        self._has_logged_ready = False
        self._await_kernels()

    def deactivate(self) -> None:
        """Close the inputs."""
        super().deactivate()
        self._cameras.close()

    def _take_target(self, topic: str, kind: Any, read: Callable[[Any], Box]) -> None:
        """Start on the boxes that messages on `topic` give, those with a header in its frame."""

        def start(message: Any, path: ImagePath) -> None:
            assert self.feed is not None
            # A RegionOfInterest has no header, and so no frame to be wrong.
            if kind is not RegionOfInterest:
                path.check_frame_id(topic, message.header)
            self.feed.start_on(read(message))

        self.listen(kind, topic, "target", start)

    def _box_at(self, message: PointStamped) -> Box:
        return target_messages.box_of_point(
            message, self.feed.box if self.feed is not None else None
        )

    def _await_kernels(self) -> None:
        """Log once that the node is ready: active, and with kernels."""
        source = self.diagnostics.source
        if self.feed is None or not self.feed.get_ready():
            return
        # Until parameters are changed, which may ask for other kernels.
        self._ready_timer.cancel()
        if source is not None and not self._has_logged_ready:
            self._has_logged_ready = True
            kernels = self.feed.facts["kernels"]
            words = f"ready: images on {source}, {self.feed.target_words}, {kernels} kernels"
            self.get_logger().info(words)

    def _reconfigure(self, configuration: Configuration) -> None:
        super()._reconfigure(configuration)
        if self.feed is not None:
            self._ready_timer.reset()
        if self.diagnostics.source is not None:
            self._cameras.open(configuration.session.road)
