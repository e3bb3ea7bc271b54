# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The few ROS messages that our recordings hold, and CDR bytes of any, without ROS.

The definitions of the messages that Foxglove draws over images, the fields of ROS 2 Jazzy's
foxglove_msgs, stand in ImageAnnotations.msg and in each recording, so that neither writing nor
reading one needs that ROS package.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
import numpy.typing as npt
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, check_frame
from vehicle_pf_tracker.image.formats.encodings import fields_of_frame

IMAGE_TOPIC = "/camera/image_raw"
COMPRESSED_TOPIC = "/camera/image_raw/compressed"

IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
POINT_STAMPED = "geometry_msgs/msg/PointStamped"
POLYGON_STAMPED = "geometry_msgs/msg/PolygonStamped"
DIAGNOSTIC_ARRAY = "diagnostic_msgs/msg/DiagnosticArray"

IMAGE_TYPES = (IMAGE, COMPRESSED_IMAGE)
STAMPED_TYPES = (*IMAGE_TYPES, POINT_STAMPED, POLYGON_STAMPED, DIAGNOSTIC_ARRAY)
"""Types that begin with a header, of those in our recordings."""

CAMERA_FRAME = "camera"
"""The `frame_id` of everything in our recordings."""

IMAGE_ANNOTATIONS = "foxglove_msgs/msg/ImageAnnotations"

# rosbags before 0.11 lets what a broken message causes through as it is.
_BROKEN = (SerdeError, struct.error, ValueError, IndexError, AssertionError)

# Levels of a diagnostic status, as `diagnostic_msgs/DiagnosticStatus` numbers them.
OK = 0
WARN = 1
ERROR = 2


@cache
def _store() -> Typestore:
    store = get_typestore(Stores.ROS2_JAZZY)
    text = resources.files(__package__).joinpath("ImageAnnotations.msg").read_text()
    store.register(get_types_from_msg(text, IMAGE_ANNOTATIONS))
    return store


def message_class(type_name: str) -> Any:
    """Return the class of a type like ``geometry_msgs/msg/PointStamped``.

    Raises
    ------
    InputError
        If neither ROS 2 Jazzy's common interfaces nor `foxglove_types` have such a type.
    """
    try:
        return _store().types[type_name]
    except KeyError:
        raise InputError(f"the message type {type_name!r} is unknown") from None


def serialize(message: Any, type_name: str) -> memoryview:
    """Serialize `message` to CDR, its encapsulation header included.

    Raises
    ------
    InputError
        If the type is unknown.
    """
    # Asked for its class first: an unknown type then has a sentence and not a KeyError.
    message_class(type_name)
    return _store().serialize_cdr(message, type_name)


def deserialize(data: memoryview, type_name: str) -> Any:
    """Read a message from CDR; arrays in it are views of `data`.

    Raises
    ------
    InputError
        If the bytes are not a message of this type.
    """
    message_class(type_name)
    try:
        return _store().deserialize_cdr(data, type_name)
    except _BROKEN as error:
        raise InputError(f"a message is not a valid {type_name}: {error}") from error


@cache
def definition(type_name: str) -> str:
    """Return the type's full definition, the types it is made of appended (`ros2msg`)."""
    message_class(type_name)
    return _store().generate_msgdef(type_name, ros_version=2)[0]


@cache
def type_hash(type_name: str) -> str:
    """Return the type's hash as ROS 2 computes it (REP 2011, ``RIHS01_...``)."""
    message_class(type_name)
    return _store().hash_rihs01(type_name)


def as_token(name: str) -> str:
    """Return `name` as a part of a topic: letters, digits and underscores, no digit first."""
    # Letters of other alphabets are not allowed in topics, as isalnum alone would have them.
    token = "".join(c if c.isascii() and c.isalnum() else "_" for c in name)
    return f"_{token}" if token[:1].isdigit() else token


def header(stamp_ns: int, frame_id: str = CAMERA_FRAME) -> Any:
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
    data = np.ascontiguousarray(check_frame(frame)).reshape(-1)
    return message_class(IMAGE)(header=header(stamp_ns), **fields_of_frame(frame), data=data)


def compressed_image(stamp_ns: int, image_format: str, data: bytes) -> Any:
    """Make a compressed image of the bytes of a file; `image_format` is ``jpeg`` or ``png``."""
    return message_class(COMPRESSED_IMAGE)(
        header=header(stamp_ns), format=image_format, data=np.frombuffer(data, np.uint8)
    )


def point_stamped(stamp_ns: int, x: float, y: float, z: float = 0.0) -> Any:
    """Make a point, here a position in px."""
    point = message_class("geometry_msgs/msg/Point")(x=float(x), y=float(y), z=float(z))
    return message_class(POINT_STAMPED)(header=header(stamp_ns), point=point)


def polygon_stamped(
    stamp_ns: int, corners: Sequence[tuple[float, float]] | npt.NDArray[np.float64]
) -> Any:
    """Make a polygon of corners (x, y) in px; ROS keeps them in single precision."""
    point = message_class("geometry_msgs/msg/Point32")
    points = [point(x=float(x), y=float(y), z=0.0) for x, y in corners]
    polygon = message_class("geometry_msgs/msg/Polygon")(points=points)
    return message_class(POLYGON_STAMPED)(header=header(stamp_ns), polygon=polygon)


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
    return message_class(DIAGNOSTIC_ARRAY)(header=header(stamp_ns), status=[status])
