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
from rclpy.clock import Clock, ClockType
from rclpy.subscription import Subscription
from sensor_msgs.msg import RegionOfInterest
from std_srvs.srv import Trigger

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.road.camera import PoseTree
from vehicle_pf_tracker.ros.messages import detection_type
from vehicle_pf_tracker.ros.node.camera_inputs import CameraInputs
from vehicle_pf_tracker.ros.node.image_input import image_topic
from vehicle_pf_tracker.ros.node.image_node import ImageNode
from vehicle_pf_tracker.ros.node.outputs import Outputs
from vehicle_pf_tracker.ros.node.stream import Stream
from vehicle_pf_tracker.ros.node.target_messages import (
    box_of_detection,
    box_of_point,
    box_of_polygon,
    box_of_region,
)
from vehicle_pf_tracker.ros.road_messages import ImageLens
from vehicle_pf_tracker.trackers.registry import Variant

_POLL = 0.1
"""Interval of the check for loaded kernels while no image asks for them, s."""


class TrackerNode(ImageNode):
    """Managed node of one variant; active at once unless the parameter `autostart` is false.

    Parameters
    ----------
    variant : Variant
        From the registry; the node is called ``<variant>_tracker``.
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

    def __init__(self, variant: Variant, **options: Any) -> None:
        super().__init__(f"{variant.name}_tracker", **options)
        self._variant = variant
        self.stream: Stream | None = None
        self._outputs: Outputs | None = None
        self._target_inputs: list[Subscription] = []
        self._cameras = CameraInputs(self, self._take_lens, self._take_poses)
        self.begin(Configuration.of(variant))

    def configure(self) -> None:
        """Make the session and the outputs."""
        configuration = self.table.configuration
        topic = image_topic(self, configuration.node.image_transport)
        self._outputs = Outputs(self, topic)
        health = self.diagnostics.begin()
        self.stream = Stream(self, self._variant, configuration, self._outputs, health)
        self.diagnostics.facts = {"variant": self._variant.name, **self.stream.facts}
        self._is_told_ready = False
        # Steady, because simulated time may stand still while kernels are loaded.
        self._poll = self.create_timer(
            _POLL, self._await_kernels, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )
        self._reset_service = self.create_service(Trigger, "~/reset", self._on_reset)

    def activate(self) -> None:
        """Open the inputs."""
        assert self.stream is not None
        self.open_images()
        self.warn_of_overrides()
        self._cameras.open(self.table.configuration.session.road)
        self._target_inputs = [
            self.create_subscription(RegionOfInterest, "~/set_target", self._on_region, 10),
            self.create_subscription(PolygonStamped, "~/set_box", self._on_polygon, 10),
            self.create_subscription(PointStamped, "~/clicked_point", self._on_point, 10),
        ]
        kind = detection_type()
        if kind is not None:
            wanted = self.create_subscription(kind, "~/set_detection", self._on_detection, 10)
            self._target_inputs.append(wanted)
        self._is_told_ready = False
        self._await_kernels()

    def deactivate(self) -> None:
        """Close the inputs: an inactive node pays nothing for images."""
        self.diagnostics.cease()
        self._cameras.close()
        while self._target_inputs:
            self.destroy_subscription(self._target_inputs.pop())

    def cleanup(self) -> None:
        """Release session and outputs."""
        if self._outputs is not None:
            self._outputs.close()
            self.destroy_service(self._reset_service)
            self.destroy_timer(self._poll)
        self._outputs = self.stream = None

    def _on_region(self, message: RegionOfInterest) -> None:
        self._set_target(lambda stream: box_of_region(message))

    def _on_polygon(self, message: PolygonStamped) -> None:
        self._set_target(lambda stream: box_of_polygon(message, stream.frame_id, self._suffix))

    def _on_point(self, message: PointStamped) -> None:
        self._set_target(
            lambda stream: box_of_point(message, stream.frame_id, stream.box, self._suffix)
        )

    def _on_detection(self, message: Any) -> None:
        self._set_target(lambda stream: box_of_detection(message, stream.frame_id, self._suffix))

    @property
    def _suffix(self) -> str:
        """Addition to the images' frame_id in outputs, which inputs may have too."""
        return self.table.configuration.node.output_frame_suffix

    def _take_lens(self, found: ImageLens) -> None:
        if self.stream is not None:
            self.stream.localisation.take_lens(found)

    def _take_poses(self, tree: PoseTree) -> None:
        if self.stream is not None:
            self.stream.localisation.take_poses(tree)

    def _set_target(self, read: Callable[[Stream], Box]) -> None:
        if self.stream is None:
            return
        try:
            self.stream.set_target(read(self.stream))
        except InputError as error:
            self.stream.refuse_target(str(error))

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        assert self.stream is not None
        try:
            self.stream.reset()
        except InputError as error:
            response.success, response.message = False, str(error)
        else:
            response.success, response.message = True, self.stream.target_words
        return response

    def _await_kernels(self) -> None:
        """Log once that the node is ready: active, and with kernels."""
        source = self.diagnostics.source
        if self.stream is None or not self.stream.get_ready():
            return
        self._poll.cancel()
        self.diagnostics.facts.update(self.stream.facts)
        if source is not None and not self._is_told_ready:
            self._is_told_ready = True
            kernels = self.stream.facts["kernels"]
            words = f"ready: images on {source}, {self.stream.target_words}, {kernels} kernels"
            self.get_logger().info(words)

    def _check(self, configuration: Configuration) -> None:
        if self.stream is not None:
            self.stream.check(configuration)

    def _reconfigure(self, configuration: Configuration) -> None:
        if self.stream is not None:
            self.stream.reconfigure(configuration)
            self.diagnostics.facts.update(self.stream.facts)
            self._poll.reset()
        if self.diagnostics.source is not None:
            self._cameras.open(configuration.session.road)
