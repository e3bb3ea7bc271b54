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

"""The publishers of a node and what goes out for one image."""

from __future__ import annotations

from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PolygonStamped, Vector3Stamped
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Header

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros.messages import (
    box_message,
    image_message,
    mode_message,
    particles_message,
    position_message,
    velocity_message,
)
from vehicle_pf_tracker.ros.node.located_outputs import LocatedOutputs, in_frame, is_heard
from vehicle_pf_tracker.ros.node.overlay import Overlay
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.localisation import Localisation

_RELIABLE = QoSProfile(depth=10)
_BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class Outputs:
    """Everything that a configured node publishes; what nobody listens to is not even made.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    hardware_id : str
        Where the images come from, for `~/mode`.
    """

    def __init__(self, node: LifecycleNode, hardware_id: str) -> None:
        self._node = node
        self._hardware_id = hardware_id
        self._overlay = Overlay()
        self._kept_position = PointStamped()
        create = node.create_lifecycle_publisher
        # ~/mode last, here and below: it tells a lock-step replay that the image is done with.
        self._position = create(PointStamped, "~/position", _RELIABLE)
        self._box = create(PolygonStamped, "~/box", _RELIABLE)
        self._velocity = create(Vector3Stamped, "~/velocity", _RELIABLE)
        self._particles = create(PointCloud2, "~/particles", _BEST_EFFORT)
        self._located = LocatedOutputs(node, _RELIABLE)
        self._picture = create(Image, "~/overlay", _BEST_EFFORT)
        self._mode = create(DiagnosticArray, "~/mode", _RELIABLE)

    def close(self) -> None:
        """Destroy the publishers."""
        for publisher in (
            self._position, self._box, self._velocity, self._particles, self._picture, self._mode,
        ):  # fmt: skip
            self._node.destroy_lifecycle_publisher(publisher)
        self._located.close()

    def discard_path(self) -> None:
        """Begin a new path in the overlay."""
        self._overlay.discard_path()

    def publish_estimate(
        self,
        header: Header,
        estimate: Estimate,
        own: NodeParameters,
        localisation: Localisation,
        frame_period: float,
    ) -> None:
        """Publish where the vehicle is; `frame_period` in s makes px/frame to px/s."""
        self._overlay.follow(estimate)
        switches = own.publish
        if own.output_frame_suffix:
            header = in_frame(header, header.frame_id + own.output_frame_suffix)
        if is_heard(self._position):
            self._position.publish(position_message(header, estimate, self._kept_position))
        if switches.box and is_heard(self._box):
            self._box.publish(box_message(header, estimate))
        if switches.velocity and is_heard(self._velocity):
            self._velocity.publish(velocity_message(header, estimate, frame_period))
        if switches.particles and is_heard(self._particles):
            self._particles.publish(particles_message(header, estimate))
        self._located.publish(header, estimate, localisation)

    def publish_overlay(
        self, header: Header, frame: Frame, mode: str, estimate: Estimate | None, words: str = ""
    ) -> None:
        """Publish the drawn-on image with `words`, if anybody looks."""
        if is_heard(self._picture):
            picture = self._overlay.draw(frame, mode, estimate, words)
            self._picture.publish(image_message(header, picture))

    def publish_mode(
        self,
        header: Header,
        mode: str,
        values: Mapping[str, object],
        estimate: Estimate | None = None,
    ) -> None:
        """Publish the one `~/mode` of an image: the scalars of its estimate, and `values`."""
        if not is_heard(self._mode):
            return
        name = f"{self._node.get_name()}: target"
        scalars = estimate.scalars() if estimate is not None else {}
        all_values = {**scalars, **values}
        self._mode.publish(mode_message(header, name, self._hardware_id, mode, all_values))
