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

"""Outputs that say more than pixels: uncertainty, places on the road, detections."""

from __future__ import annotations

import copy

import numpy as np
from geometry_msgs.msg import PointStamped, PoseWithCovarianceStamped, Vector3Stamped
from rclpy.lifecycle import LifecycleNode, LifecyclePublisher
from rclpy.qos import QoSProfile
from std_msgs.msg import Header

from vehicle_pf_tracker.ros.detections import detection_message, detection_type
from vehicle_pf_tracker.ros.road_messages import (
    place_message,
    pose_message,
    road_velocity_message,
)
from vehicle_pf_tracker.trackers.estimate import START, Estimate
from vehicle_pf_tracker.trackers.localisation import Localisation


def is_heard(publisher: LifecyclePublisher) -> bool:
    """Return whether anybody subscribes."""
    return bool(publisher.get_subscription_count())


def in_frame(header: Header, frame_id: str) -> Header:
    """Return a header of the same stamp in another frame."""
    other = copy.copy(header)
    other.frame_id = frame_id
    return other


class LocatedOutputs:
    """Publishers of what `Localisation` adds to an estimate, and of detections.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    qos : QoSProfile
        Of all of them.
    """

    def __init__(self, node: LifecycleNode, qos: QoSProfile) -> None:
        self._node = node
        self._track = 0
        create = node.create_lifecycle_publisher
        self._pose = create(PoseWithCovarianceStamped, "~/pose_with_covariance", qos)
        self._place = create(PointStamped, "~/road_position", qos)
        self._velocity = create(Vector3Stamped, "~/road_velocity", qos)
        kind = detection_type()
        self._detection = None if kind is None else create(kind, "~/detection", qos)

    def close(self) -> None:
        """Destroy the publishers."""
        for publisher in (self._pose, self._place, self._velocity, self._detection):
            if publisher is not None:
                self._node.destroy_lifecycle_publisher(publisher)

    def publish(self, header: Header, estimate: Estimate, localisation: Localisation) -> None:
        """Publish what is subscribed to; `header` is that of pixel outputs."""
        self._track += estimate.regime == START
        if self._detection is not None and is_heard(self._detection):
            self._detection.publish(detection_message(header, estimate, str(self._track)))
        if localisation.has_road:
            self._publish_road(header, localisation)
        elif is_heard(self._pose):
            position = np.asarray(estimate.position)
            self._pose.publish(pose_message(header, position, localisation.covariance))

    def _publish_road(self, header: Header, localisation: Localisation) -> None:
        road = localisation.road
        if road is None:
            return
        there = in_frame(header, localisation.parameters.frame_id)
        if is_heard(self._pose):
            self._pose.publish(pose_message(there, road.position, road.covariance))
        if is_heard(self._place):
            self._place.publish(place_message(there, road.position))
        if is_heard(self._velocity):
            self._velocity.publish(road_velocity_message(there, road.velocity))
