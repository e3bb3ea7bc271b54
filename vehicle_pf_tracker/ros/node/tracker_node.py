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

"""The tracker node: images in, estimates out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import PointStamped, PolygonStamped
from sensor_msgs.msg import RegionOfInterest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import (
    box_of_detection,
    box_of_point,
    box_of_polygon,
    box_of_region,
    detection_type,
)
from vehicle_pf_tracker.ros.node.camera_inputs import CameraInputs
from vehicle_pf_tracker.ros.node.image_input import image_topic
from vehicle_pf_tracker.ros.node.image_node import ImageNode
from vehicle_pf_tracker.ros.node.outputs import TrackerOutputs
from vehicle_pf_tracker.ros.node.stream import Stream
from vehicle_pf_tracker.trackers.registry import Variant

_POLL = 0.1
"""Interval of the check for loaded kernels while no image asks for them, s."""


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
    stream : Stream or None
        Processing of the images; None while the node is not configured.

    Raises
    ------
    InputError
        If a parameter or a QoS override does not fit.
    """

    stream: Stream | None

    def __init__(self, variant: Variant, **options: Any) -> None:
        super().__init__(f"{variant.name}_tracker", **options)
        self._variant = variant
        self._cameras = CameraInputs(self)
        self.begin(Configuration.of(variant))

    def prepare(self) -> None:
        """Make session, outputs and services."""
        configuration = self.table.configuration
        outputs = TrackerOutputs(self, image_topic(self, configuration.node.image_transport))
        self._outputs = outputs
        health = self.diagnostics.begin()
        self.stream = Stream(self, self._variant, configuration, outputs, health, self._cameras)
        self._has_logged_ready = False
        self._ready_timer = self.poll(_POLL, self._await_kernels)

    def activate(self) -> None:
        """Open the inputs."""
        self.open_images()
        self.warn_of_overrides()
        self._cameras.open(self.table.configuration.session.road)
        self.listen(RegionOfInterest, "~/set_target", self._on_region)
        self.listen(PolygonStamped, "~/set_box", self._on_polygon)
        self.listen(PointStamped, "~/clicked_point", self._on_point)
        if detection_type() is not None:
            self.listen(detection_type(), "~/set_detection", self._on_detection)
        self._has_logged_ready = False
        self._await_kernels()

    def deactivate(self) -> None:
        """Close the inputs."""
        super().deactivate()
        self._cameras.close()

    def _on_region(self, message: RegionOfInterest) -> None:
        self._set_target(lambda stream: box_of_region(message))

    def _on_polygon(self, message: PolygonStamped) -> None:
        self._set_target(lambda stream: box_of_polygon(message), "~/set_box", message)

    def _on_point(self, message: PointStamped) -> None:
        self._set_target(
            lambda stream: box_of_point(message, stream.box), "~/clicked_point", message
        )

    def _on_detection(self, message: Any) -> None:
        self._set_target(lambda stream: box_of_detection(message), "~/set_detection", message)

    def _set_target(
        self, read: Callable[[Stream], Box], topic: str = "", message: Any = None
    ) -> None:
        """Start on the box that is read; a message with a header is to be in the images' frame."""

        def start(stream: Stream) -> None:
            if message is not None:
                stream.check_frame_id(topic, message.header)
            stream.start_on(read(stream))

        self.ask("target", start)

    def _await_kernels(self) -> None:
        """Log once that the node is ready: active, and with kernels."""
        source = self.diagnostics.source
        if self.stream is None or not self.stream.get_ready():
            return
        self._ready_timer.cancel()
        if source is not None and not self._has_logged_ready:
            self._has_logged_ready = True
            kernels = self.stream.facts["kernels"]
            words = f"ready: images on {source}, {self.stream.target_words}, {kernels} kernels"
            self.get_logger().info(words)

    def _reconfigure(self, configuration: Configuration) -> None:
        super()._reconfigure(configuration)
        if self.stream is not None:
            self._ready_timer.reset()
        if self.diagnostics.source is not None:
            self._cameras.open(configuration.session.road)
