# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates as messages, px. Headers are the image's own.

Those of vision_msgs exist only where that package is installed.
"""

from __future__ import annotations

import array
import math
from collections.abc import Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import (
    Point32,
    PointStamped,
    PolygonStamped,
    PoseWithCovarianceStamped,
    Vector3Stamped,
)
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import Header

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.formats.encodings import fields_of_frame
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

if TYPE_CHECKING:  # a node imports the code of its own variant only
    from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

try:
    from vision_msgs.msg import Detection2D, Detection2DArray, ObjectHypothesisWithPose
except ImportError:  # an optional package: the nodes work without its topics
    Detection2D = Detection2DArray = ObjectHypothesisWithPose = None

WAITING_MESSAGE = "WAITING"
"""Message of `~/mode` while there is no target."""

NOT_READY = "loading kernels"
"""Beginning of every answer that a node gives only until its kernels are loaded."""

REJECTED_MESSAGE = "REJECTED"
"""Message of `~/mode` for an image that could not be used."""

TENTATIVE = "TENTATIVE"
"""Message of `~/mode` for one of many vehicles, as long as there is too little evidence of it."""

LEVELS: Mapping[str, bytes] = {
    TENTATIVE: DiagnosticStatus.WARN,
    Mode.TRACKING.value: DiagnosticStatus.OK,
    Mode.OCCLUDED.value: DiagnosticStatus.WARN,
    Mode.LOST.value: DiagnosticStatus.ERROR,
    WAITING_MESSAGE: DiagnosticStatus.OK,
    REJECTED_MESSAGE: DiagnosticStatus.ERROR,
}
"""Level of each message of `~/mode`: an operator has to look at errors, and may at warnings."""

UNKNOWN_ANGLE = math.pi**2 / 3
"""Variance of an angle that nothing is known of, rad²: that of the even density over a turn."""

_DATATYPES = {"<u4": PointField.UINT32, "|u1": PointField.UINT8, "<f4": PointField.FLOAT32}
"""ROS's number of each type of a field, by numpy's name."""
_PARTICLE = np.dtype([(name, "<f4") for name in ("x", "y", "z", "weight")])
"""A point of `~/particles`: RViz draws clouds that have x, y and z as 32-bit numbers."""

Status = tuple[bytes, str, str, Mapping[str, object]]
"""Level, subject, words and values of a status."""


def stamp_ns(header: Header) -> int:
    """Stamp of a header in ns."""
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)


def status(
    level: bytes, name: str, words: str, hardware_id: str, values: Mapping[str, object]
) -> DiagnosticStatus:
    """Make a status; every number in it can be read back to its last digit."""
    pairs = [
        # float() first: numpy's own numbers write their type's name too.
        KeyValue(key=key, value=repr(float(one)) if isinstance(one, float) else str(one))
        for key, one in values.items()
    ]
    return DiagnosticStatus(
        level=level, name=name, message=words, hardware_id=hardware_id, values=pairs
    )


def point_message(header: Header, point: Sequence[float] | Array) -> PointStamped:
    """Make a position: in px, or in m on the road; z = 0."""
    message = PointStamped(header=header)
    message.point.x, message.point.y = map(float, point)
    return message


def box_message(header: Header, box: Box) -> PolygonStamped:
    """Make the four corners, in px, clockwise in the image from the top left."""
    message = PolygonStamped(header=header)
    message.polygon.points = [Point32(x=float(x), y=float(y)) for x, y in box.corners]
    return message


def velocity_message(
    header: Header, velocity: Sequence[float] | Array, period: float = 1.0
) -> Vector3Stamped:
    """Make a velocity per second of one per `period` s: in px/s, or in m/s on the road."""
    message = Vector3Stamped(header=header)
    message.vector.x, message.vector.y = (float(value / period) for value in velocity)
    return message


def particles_message(header: Header, estimate: Estimate) -> PointCloud2:
    """Make the cloud: x, y in px, z = 0, and the normalised weight of each particle."""
    points = np.zeros(len(estimate.weights), _PARTICLE)
    points["x"], points["y"] = estimate.particles.T
    points["weight"] = estimate.weights
    return cloud_message(header, points)


def cloud_message(header: Header, points: npt.NDArray[np.void]) -> PointCloud2:
    """Make the cloud of structured points (N,), whose names and types are those of its fields."""
    kind = points.dtype
    return PointCloud2(
        header=header,
        height=1,
        width=len(points),
        fields=_fields(kind),
        is_bigendian=False,
        point_step=kind.itemsize,
        row_step=kind.itemsize * len(points),
        data=packed(points.view(np.uint8)),
        is_dense=True,
    )


@cache
def _fields(kind: np.dtype[np.void]) -> list[PointField]:
    """Describe the fields of points; made once for each kind."""
    return [
        PointField(name=name, offset=offset, datatype=_DATATYPES[of.str], count=1)
        for name, (of, offset, *_) in (kind.fields or {}).items()
    ]


def pose_message(header: Header, position: Array, covariance: Array) -> PoseWithCovarianceStamped:
    """Make a position with its covariance (2, 2), in px or m; nothing is known of its heading."""
    message = PoseWithCovarianceStamped(header=header)
    pose = message.pose
    pose.pose.position.x, pose.pose.position.y = map(float, position)
    pose.pose.orientation.w = 1.0
    # Six rows and columns: x, y, z, and the angles about them.
    numbers = np.diag([0.0, 0.0, 0.0, UNKNOWN_ANGLE, UNKNOWN_ANGLE, UNKNOWN_ANGLE])
    numbers[:2, :2] = covariance
    pose.covariance = numbers.ravel()
    return message


def image_message(header: Header, frame: Frame) -> Image:
    """Make an rgb8 image of a contiguous frame."""
    return Image(header=header, **fields_of_frame(frame), data=packed(frame))


def packed(values: npt.NDArray[Any]) -> array.array[int]:
    """Return the bytes of a contiguous array for a message's `data`."""
    # The one quick way: rclpy checks every element of anything else, 126 ms for 640x480.
    data = array.array("B")
    data.frombytes(values.data.cast("B"))
    return data


CLASS = "vehicle"
"""Class of a detection that goes out."""


def detection_type() -> Any:
    """Return the message type; None where vision_msgs is not installed."""
    return Detection2D


def detections_type() -> Any:
    """Return the message type of several; None where vision_msgs is not installed."""
    return Detection2DArray


def detection_message(
    header: Header, estimate: Estimate | TrackEstimate, identity: str, label: str = CLASS
) -> Any:
    """Make the detection: box in px, confidence as score, class, and the id of the track."""
    message = Detection2D(header=header, id=identity)
    x, y = estimate.box.centre
    message.bbox.center.position.x = float(x)
    message.bbox.center.position.y = float(y)
    message.bbox.size_x = float(estimate.box.width)
    message.bbox.size_y = float(estimate.box.height)
    result = ObjectHypothesisWithPose()
    result.hypothesis.class_id = label
    result.hypothesis.score = float(estimate.confidence)
    message.results = [result]
    return message
