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
from rclpy.lifecycle import LifecycleNode
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.drawing import Colour, draw_box, line_width
from vehicle_pf_tracker.offline.traffic_drawing import annotated
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros.messages import detections_type, image_message
from vehicle_pf_tracker.ros.node.outputs import RELIABLE, Outputs, in_pixels
from vehicle_pf_tracker.ros.traffic.messages import (
    counts_message,
    detections_message,
    markers_message,
    modes_message,
    tracks_message,
)
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED, Counter, Crossing
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

_SELECTED: Colour = (255, 255, 255)


class TrafficOutputs(Outputs):
    """Everything that a configured node of many vehicles publishes.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    hardware_id : str
        Topic of the images, for the statuses.
    """

    def __init__(self, node: LifecycleNode, hardware_id: str) -> None:
        more = {
            "tracks": (PointCloud2, RELIABLE),
            "modes": (DiagnosticArray, RELIABLE),
            "counts": (DiagnosticArray, RELIABLE),
            "detections": (detections_type(), RELIABLE),
            "markers": (MarkerArray, RELIABLE),
        }
        super().__init__(node, hardware_id, more)

    def publish_vehicles(
        self,
        header: Header,
        estimates: Sequence[TrackEstimate],
        own: NodeParameters,
        frame_period: float,
    ) -> None:
        """Publish all vehicles; `frame_period` in s makes px/frame to px/s."""
        name, there = self.node_name, in_pixels(header, own)
        self.send("tracks", tracks_message, there, estimates, frame_period)
        self.send("modes", modes_message, header, name, self.hardware_id, estimates)
        self.send("detections", detections_message, there, estimates)
        self.send("markers", markers_message, there, estimates)

    def publish_counts(
        self, header: Header, counter: Counter, latest: Mapping[str, Crossing]
    ) -> None:
        """Publish what was counted, and the last crossing of each place."""
        name = self.node_name
        self.send("counts", counts_message, header, name, self.hardware_id, counter, latest)

    def publish_overlay(
        self,
        header: Header,
        frame: Frame,
        estimates: Sequence[TrackEstimate],
        counter: Counter | None,
        selected: TrackEstimate | None,
    ) -> None:
        """Publish the drawn-on image, if anybody looks; the selected vehicle has a white frame."""
        if not self.is_heard("overlay"):
            return
        if selected is not None:
            frame = np.array(frame, order="C")
            draw_box(frame, selected.box, _SELECTED, 3 * line_width(frame))
        confirmed = sum(one.mode in CONFIRMED for one in estimates)
        picture = annotated(frame, f"{confirmed} vehicles", estimates, counter)
        self.send("overlay", image_message, header, picture)
