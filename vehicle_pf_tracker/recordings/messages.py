"""Makers of the few ROS messages that our recordings hold, without ROS."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, check_frame
from vehicle_pf_tracker.recordings import topics
from vehicle_pf_tracker.recordings.cdr import message_class

OK, WARN, ERROR = 0, 1, 2
"""Levels of a diagnostic status."""


def header(stamp_ns: int, frame_id: str = topics.CAMERA_FRAME) -> Any:
    """Make a `std_msgs/Header` with this stamp in ns."""
    seconds, nanoseconds = divmod(stamp_ns, 1_000_000_000)
    stamp = message_class("builtin_interfaces/msg/Time")(sec=seconds, nanosec=nanoseconds)
    return message_class("std_msgs/msg/Header")(stamp=stamp, frame_id=frame_id)


def stamp_ns(message: Any) -> int:
    """Read the header stamp of a message in ns."""
    stamp = message.header.stamp
    return int(stamp.sec * 1_000_000_000 + stamp.nanosec)


def image(stamp_ns: int, frame: Frame) -> Any:
    """Make an `rgb8` image; the data are `frame` itself where it is contiguous."""
    height, width = check_frame(frame).shape[:2]
    return message_class(topics.IMAGE)(
        header=header(stamp_ns),
        height=height,
        width=width,
        encoding="rgb8",
        is_bigendian=0,
        step=3 * width,
        data=np.ascontiguousarray(frame).reshape(-1),
    )


def compressed_image(stamp_ns: int, image_format: str, data: bytes) -> Any:
    """Make a compressed image of the bytes of a file; `image_format` is ``jpeg`` or ``png``."""
    return message_class(topics.COMPRESSED_IMAGE)(
        header=header(stamp_ns), format=image_format, data=np.frombuffer(data, np.uint8)
    )


def point_stamped(stamp_ns: int, x: float, y: float, z: float = 0.0) -> Any:
    """Make a point, here a position in px."""
    point = message_class("geometry_msgs/msg/Point")(x=float(x), y=float(y), z=float(z))
    return message_class(topics.POINT_STAMPED)(header=header(stamp_ns), point=point)


def polygon_stamped(
    stamp_ns: int, corners: Sequence[tuple[float, float]] | npt.NDArray[np.float64]
) -> Any:
    """Make a polygon of corners (x, y) in px; ROS keeps them in single precision."""
    point = message_class("geometry_msgs/msg/Point32")
    points = [point(x=float(x), y=float(y), z=0.0) for x, y in corners]
    polygon = message_class("geometry_msgs/msg/Polygon")(points=points)
    return message_class(topics.POLYGON_STAMPED)(header=header(stamp_ns), polygon=polygon)


def diagnostic_array(
    stamp_ns: int, name: str, level: int, message: str, values: Mapping[str, str]
) -> Any:
    """Make a diagnostic array of one status with these values."""
    pair = message_class("diagnostic_msgs/msg/KeyValue")
    status = message_class("diagnostic_msgs/msg/DiagnosticStatus")(
        level=level,
        name=name,
        message=message,
        hardware_id="",
        values=[pair(key=key, value=value) for key, value in values.items()],
    )
    return message_class(topics.DIAGNOSTIC_ARRAY)(header=header(stamp_ns), status=[status])
