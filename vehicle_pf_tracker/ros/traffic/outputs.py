# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Everything that a node of many vehicles publishes."""

from __future__ import annotations

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.lifecycle import LifecycleNode
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.ros.messages import detections_type, image_message
from vehicle_pf_tracker.ros.node.outputs import RELIABLE, Outputs
from vehicle_pf_tracker.ros.traffic import messages
from vehicle_pf_tracker.ros.traffic.vehicles import Vehicles
from vehicle_pf_tracker.showing.drawing import Colour, draw_box, line_width

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
        self, header: Header, there: Header, vehicles: Vehicles, period: float
    ) -> None:
        """Publish all vehicles, px under the header `there`, and what was counted.

        The frame `period` is in s.
        """
        estimates = vehicles.estimates
        self.send("tracks", messages.tracks_message, there, estimates, period)
        self.send("modes", self.statuses, header, messages.mode_statuses(estimates))
        self.send("detections", messages.detections_message, there, estimates)
        self.send("markers", messages.markers_message, there, estimates)
        if vehicles.counter.plan.is_counting:
            counts = messages.count_statuses(vehicles.counter, vehicles.latest)
            self.send("counts", self.statuses, header, counts)

    def publish_overlay(self, header: Header, frame: Frame, vehicles: Vehicles) -> None:
        """Publish the drawn-on image, if anybody looks; the selected vehicle has a white frame."""
        if not self.is_heard("overlay"):
            return
        if vehicles.selected is not None:
            frame = np.array(frame, order="C")
            draw_box(frame, vehicles.selected.box, _SELECTED, 3 * line_width(frame))
        self.send("overlay", image_message, header, vehicles.drawn(frame))
