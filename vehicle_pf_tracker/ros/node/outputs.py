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

"""The publishers of a node and what goes out for one image.

Outputs that say more than pixels: uncertainty, places on the road, detections.

The image with what the tracker makes of it: box, path, particles, mode.
"""

from __future__ import annotations

import copy
from collections import deque
from collections.abc import Mapping

import cv2
import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    PoseWithCovarianceStamped,
    Vector3Stamped,
)
from rclpy.lifecycle import LifecycleNode, LifecyclePublisher
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Header

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.drawing import line_width, write_words
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros.messages import (
    box_message,
    detection_message,
    detection_type,
    image_message,
    mode_message,
    particles_message,
    position_message,
    velocity_message,
)
from vehicle_pf_tracker.ros.road_messages import (
    place_message,
    pose_message,
    road_velocity_message,
)
from vehicle_pf_tracker.trackers.estimate import START, Estimate, Mode
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


PATH_LENGTH = 300
"""Positions shown of the path."""

_COLOURS = {
    Mode.TRACKING.value: (64, 220, 64),
    Mode.OCCLUDED.value: (255, 176, 0),
    Mode.LOST.value: (255, 48, 48),
}
_NEUTRAL = (200, 200, 200)
_PARTICLE = (96, 160, 255)


class Overlay:
    """Remembers the path and draws; the frame itself is not written to."""

    def __init__(self) -> None:
        self._path: deque[tuple[float, float]] = deque(maxlen=PATH_LENGTH)

    def discard_path(self) -> None:
        """Begin a new path."""
        self._path.clear()

    def follow(self, estimate: Estimate) -> None:
        """Add a position to the path."""
        self._path.append(estimate.position)

    def draw(self, frame: Frame, mode: str, estimate: Estimate | None, more: str = "") -> Frame:
        """Return a drawn-on copy of `frame`, contiguous; `more` is written after the mode."""
        picture = np.array(frame, order="C")
        thickness = line_width(frame)
        colour = _COLOURS.get(mode, _NEUTRAL)
        if estimate is not None:
            for centre in _pixels(estimate.particles):
                cv2.circle(picture, centre, thickness, _PARTICLE, -1)
            path = np.array(_pixels(np.asarray(self._path).reshape(-1, 2)), np.int32)
            cv2.polylines(picture, [path.reshape(-1, 1, 2)], False, colour, thickness, cv2.LINE_AA)
            corners = _pixels(np.asarray(estimate.box.corners))
            cv2.rectangle(picture, corners[0], corners[2], colour, thickness)
        words = mode if estimate is None else f"{mode} {estimate.confidence:.2f}"
        words = f"{words}  {more}" if more else words
        write_words(picture, words, (5 * thickness, 14 * thickness), colour, thickness)
        return picture


def _pixels(points: Array) -> list[tuple[int, int]]:
    """Give the pixel that each continuous position (N, 2) lies in."""
    return [(int(x), int(y)) for x, y in np.floor(points)]


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
