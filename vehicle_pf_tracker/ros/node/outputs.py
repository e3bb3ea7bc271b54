# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The publishers of a node, and everything that goes out for one image."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    PoseWithCovarianceStamped,
    Vector3Stamped,
)
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Header

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros import messages
from vehicle_pf_tracker.ros.node.answer import Answer, TrackerAnswer
from vehicle_pf_tracker.ros.node.camera_inputs import StreamLocalisation
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.showing.drawing import Annotator, draw_target
from vehicle_pf_tracker.trackers.estimate import Estimate

if TYPE_CHECKING:
    from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

RELIABLE = QoSProfile(depth=10)
"""For results: a third of a second of images may wait for a slow subscriber; ROS's usual depth."""
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""For what people look at: a late picture is worth nothing, and must not hold up the node."""

Topics = Mapping[str, tuple[Any, QoSProfile]]
"""Message type and QoS by the name below the node's; the type is None where it is not installed."""

_COMMON: Topics = MappingProxyType(
    {
        "position": (PointStamped, RELIABLE),
        "box": (PolygonStamped, RELIABLE),
        "velocity": (Vector3Stamped, RELIABLE),
        "overlay": (Image, BEST_EFFORT),
        # Last, here and for every image: it tells a lock-step replay that the image is done with.
        "mode": (DiagnosticArray, RELIABLE),
    }
)


class Outputs:
    """Publishers of a node; outputs without subscribers are not computed.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    hardware_id : str
        Topic of the images, for the statuses.
    more : Topics
        Topics of this kind of node.
    """

    def __init__(self, node: LifecycleNode, hardware_id: str, more: Topics) -> None:
        self._node = node
        self._name = str(node.get_name())
        self._hardware_id = hardware_id
        self._publishers = {
            name: node.create_lifecycle_publisher(kind, f"~/{name}", qos)
            for name, (kind, qos) in {**more, **_COMMON}.items()
            if kind is not None
        }

    def close(self) -> None:
        """Destroy the publishers."""
        for publisher in self._publishers.values():
            self._node.destroy_lifecycle_publisher(publisher)

    def is_heard(self, name: str) -> bool:
        """Return whether the topic exists and anybody subscribes to it."""
        return name in self._publishers and bool(self._publishers[name].get_subscription_count())

    def publish(self, name: str, make: Callable[..., Any], *arguments: object) -> None:
        """Publish on a topic what `make` makes of `arguments`, if anybody listens."""
        if self.is_heard(name):
            self._publishers[name].publish(make(*arguments))

    def publish_vehicle(
        self, header: Header, estimate: Estimate | TrackEstimate, own: NodeParameters, period: float
    ) -> None:
        """Publish where a vehicle is; the frame `period` in s makes px/frame to px/s."""
        self.publish("position", messages.point_message, header, estimate.position)
        if own.publish.box:
            self.publish("box", messages.box_message, header, estimate.box)
        if own.publish.velocity:
            self.publish("velocity", messages.velocity_message, header, estimate.velocity, period)

    def publish_mode(self, answer: Answer, *, is_kept: bool) -> DiagnosticArray | None:
        """Publish and return the one `~/mode` of an image.

        It is None where nobody listens, unless the caller keeps it.
        """
        if not (is_kept or self.is_heard("mode")):
            return None
        level = messages.LEVELS[answer.mode]
        if answer.is_doubtful:
            level = max(level, DiagnosticStatus.WARN)
        status = level, "target", answer.mode, {"mode": answer.mode, **answer.values}
        message = self.statuses(answer.header, [status])
        self.publish("mode", lambda: message)
        return message

    def statuses(self, header: Header, found: Iterable[messages.Status]) -> DiagnosticArray:
        """Make statuses of this node."""
        name = self._name
        topic = self._hardware_id
        made = [
            messages.status(level, f"{name}: {subject}", words, topic, values)
            for level, subject, words, values in found
        ]
        return DiagnosticArray(header=header, status=made)


def in_frame(header: Header, frame_id: str) -> Header:
    """Return a header of the same stamp in another frame."""
    other = copy.copy(header)
    other.frame_id = frame_id
    return other


def in_pixels(header: Header, own: NodeParameters) -> Header:
    """Return the header of pixel outputs, whose frame has the suffix that the parameters give."""
    suffix = own.output_frame_suffix
    return in_frame(header, header.frame_id + suffix) if suffix else header


class TrackerOutputs(Outputs):
    """Everything that a configured node of one target publishes.

    Parameters
    ----------
    node : LifecycleNode
        Its publishers are silent unless it is active.
    hardware_id : str
        Topic of the images, for `~/mode`.
    localisation : StreamLocalisation
        Uncertainty of the estimates, and the road.
    journal : Journal
        Log and counts.
    """

    def __init__(
        self,
        node: LifecycleNode,
        hardware_id: str,
        localisation: StreamLocalisation,
        journal: Journal,
    ) -> None:
        more = {
            "particles": (PointCloud2, BEST_EFFORT),
            "pose_with_covariance": (PoseWithCovarianceStamped, RELIABLE),
            "road_position": (PointStamped, RELIABLE),
            "road_velocity": (Vector3Stamped, RELIABLE),
            "detection": (messages.detection_type(), RELIABLE),
        }
        super().__init__(node, hardware_id, more)
        self._localisation = localisation
        self._journal = journal
        self._annotator = Annotator(particles=True)
        self._track = 0

    def send(self, answer: Answer, own: NodeParameters, *, is_kept: bool) -> DiagnosticArray | None:
        """Publish an answer, its `~/mode` last; returns that, if it was made."""
        if isinstance(answer, TrackerAnswer):
            if answer.estimate is not None:
                self._publish_estimate(answer.header, answer.estimate, own, answer.period)
            if own.publish.overlay:
                with self._journal.drawing("the overlay"):
                    self._publish_overlay(answer)
        return self.publish_mode(answer, is_kept=is_kept)

    def _publish_estimate(
        self, header: Header, estimate: Estimate, own: NodeParameters, period: float
    ) -> None:
        """Publish where the vehicle is; the frame `period` in s makes px/frame to px/s."""
        if estimate.begins:
            self._track += 1
            self._annotator.follow(None)  # a new path
        self._annotator.follow(estimate)
        header = in_pixels(header, own)
        self.publish_vehicle(header, estimate, own, period)
        if own.publish.particles:
            self.publish("particles", messages.particles_message, header, estimate)
        self.publish("detection", messages.detection_message, header, estimate, str(self._track))
        localisation = self._localisation
        road = localisation.road
        if road is not None:
            there = in_frame(header, localisation.parameters.frame_id)
            self.publish(
                "pose_with_covariance", messages.pose_message, there, road.position, road.covariance
            )
            self.publish("road_position", messages.point_message, there, road.position)
            self.publish("road_velocity", messages.velocity_message, there, road.velocity)
        elif not localisation.has_road and self.is_heard("pose_with_covariance"):
            position = np.asarray(estimate.position)
            covariance = localisation.covariance
            self.publish(
                "pose_with_covariance", messages.pose_message, header, position, covariance
            )

    def _publish_overlay(self, answer: TrackerAnswer) -> None:
        """Publish the drawn-on image, if anybody looks; the speed stands after the mode."""
        if not self.is_heard("overlay"):
            return
        mode = answer.mode
        estimate = answer.estimate
        picture: Frame = np.array(answer.frame, order="C")
        words = mode
        if estimate is not None:
            words = f"{mode} {estimate.confidence:.2f}  {self._localisation.words}".rstrip()
        draw_target(picture, self._annotator, mode, estimate, words, row=1)
        self.publish("overlay", messages.image_message, answer.header, picture)
