# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Publishers of a node, with the outputs that every kind of node has."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    Vector3Stamped,
)
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.ros import messages
from vehicle_pf_tracker.ros.node.answer import Answer
from vehicle_pf_tracker.trackers.estimate import Estimate

if TYPE_CHECKING:
    from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

RELIABLE_QOS = QoSProfile(depth=10)
"""For results: a third of a second of images may wait for a slow subscriber; ROS's usual depth."""
BEST_EFFORT_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""For what people look at: a late picture is worth nothing, and must not hold up the node."""

Topics = Mapping[str, tuple[Any, QoSProfile]]
"""Message type and QoS by the name below the node's; the type is None where it is not installed."""

_COMMON: Topics = MappingProxyType(
    {
        "position": (PointStamped, RELIABLE_QOS),
        "box": (PolygonStamped, RELIABLE_QOS),
        "velocity": (Vector3Stamped, RELIABLE_QOS),
        "overlay": (Image, BEST_EFFORT_QOS),
        # Last, here and for every image: a lock-step replay takes it as the end of the image.
        "mode": (DiagnosticArray, RELIABLE_QOS),
    }
)


class Publishers:
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
            # A message type that is not installed costs its topic, not the node.
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
        # The worse of both: a doubt does not hide that the target is lost.
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
    # A copy, as the header is the image's own, and belongs to other outputs, too.
    other = copy.copy(header)
    other.frame_id = frame_id
    return other


def in_pixels(header: Header, own: NodeParameters) -> Header:
    """Return the header of pixel outputs, whose frame has the suffix that the parameters give."""
    suffix = own.output_frame_suffix
    return in_frame(header, header.frame_id + suffix) if suffix else header
