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

"""Publishers of the node that follows many vehicles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PolygonStamped, Vector3Stamped
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.drawing import Colour, draw_box, line_width
from vehicle_pf_tracker.offline.traffic_drawing import annotated
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros.messages import (
    box_message,
    detections_type,
    image_message,
    mode_message,
    position_message,
    velocity_message,
)
from vehicle_pf_tracker.ros.node.outputs import in_frame, is_heard
from vehicle_pf_tracker.ros.traffic.messages import (
    counts_message,
    detections_message,
    markers_message,
    modes_message,
    tracks_message,
)
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED, Counter, Crossing
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

_RELIABLE = QoSProfile(depth=10)
_BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
_SELECTED: Colour = (255, 255, 255)


class TrafficOutputs:
    """Everything that a configured node publishes; what nobody listens to is not even made.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    hardware_id : str
        Where the images come from, for the statuses.
    """

    def __init__(self, node: LifecycleNode, hardware_id: str) -> None:
        self._node = node
        self._hardware_id = hardware_id
        create = node.create_lifecycle_publisher
        # ~/mode last, here and below: it tells a lock-step replay that the image is done with.
        self._tracks = create(PointCloud2, "~/tracks", _RELIABLE)
        self._modes = create(DiagnosticArray, "~/modes", _RELIABLE)
        self._counts = create(DiagnosticArray, "~/counts", _RELIABLE)
        kind = detections_type()
        self._detections = None if kind is None else create(kind, "~/detections", _RELIABLE)
        self._markers = create(MarkerArray, "~/markers", _RELIABLE)
        self._position = create(PointStamped, "~/position", _RELIABLE)
        self._box = create(PolygonStamped, "~/box", _RELIABLE)
        self._velocity = create(Vector3Stamped, "~/velocity", _RELIABLE)
        self._picture = create(Image, "~/overlay", _BEST_EFFORT)
        self._mode = create(DiagnosticArray, "~/mode", _RELIABLE)

    def close(self) -> None:
        """Destroy the publishers."""
        for publisher in (
            self._tracks, self._modes, self._counts, self._detections, self._markers,
            self._position, self._box, self._velocity, self._picture, self._mode,
        ):  # fmt: skip
            if publisher is not None:
                self._node.destroy_lifecycle_publisher(publisher)

    def publish_vehicles(
        self,
        header: Header,
        estimates: Sequence[TrackEstimate],
        own: NodeParameters,
        frame_period: float,
    ) -> None:
        """Publish all vehicles; `frame_period` in s makes px/frame to px/s."""
        name, there = self._node.get_name(), _in_pixels(header, own)
        if is_heard(self._tracks):
            self._tracks.publish(tracks_message(there, estimates, frame_period))
        if is_heard(self._modes):
            self._modes.publish(modes_message(header, name, self._hardware_id, estimates))
        if self._detections is not None and is_heard(self._detections):
            self._detections.publish(detections_message(there, estimates))
        if is_heard(self._markers):
            self._markers.publish(markers_message(there, estimates))

    def publish_counts(
        self, header: Header, counter: Counter, latest: Mapping[str, Crossing]
    ) -> None:
        """Publish what was counted, and the last crossing of each place."""
        if is_heard(self._counts):
            name = self._node.get_name()
            self._counts.publish(counts_message(header, name, self._hardware_id, counter, latest))

    def publish_selected(
        self, header: Header, estimate: TrackEstimate, own: NodeParameters, frame_period: float
    ) -> None:
        """Publish the selected vehicle as a single tracker does."""
        there = _in_pixels(header, own)
        if is_heard(self._position):
            self._position.publish(position_message(there, estimate))
        if own.publish.box and is_heard(self._box):
            self._box.publish(box_message(there, estimate))
        if own.publish.velocity and is_heard(self._velocity):
            self._velocity.publish(velocity_message(there, estimate, frame_period))

    def publish_overlay(
        self,
        header: Header,
        frame: Frame,
        estimates: Sequence[TrackEstimate],
        counter: Counter | None,
        selected: TrackEstimate | None,
    ) -> None:
        """Publish the drawn-on image, if anybody looks; the selected vehicle has a white frame."""
        if not is_heard(self._picture):
            return
        if selected is not None:
            frame = np.array(frame, order="C")
            draw_box(frame, selected.box, _SELECTED, 3 * line_width(frame))
        confirmed = sum(one.mode in CONFIRMED for one in estimates)
        picture = annotated(frame, f"{confirmed} vehicles", estimates, counter)
        self._picture.publish(image_message(header, picture))

    def publish_mode(self, header: Header, mode: str, values: Mapping[str, object]) -> None:
        """Publish the one `~/mode` of an image."""
        if is_heard(self._mode):
            name = f"{self._node.get_name()}: target"
            self._mode.publish(mode_message(header, name, self._hardware_id, mode, values))


def _in_pixels(header: Header, own: NodeParameters) -> Header:
    suffix = own.output_frame_suffix
    return in_frame(header, header.frame_id + suffix) if suffix else header
