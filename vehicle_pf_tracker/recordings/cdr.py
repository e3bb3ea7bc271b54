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

"""ROS messages and their CDR bytes, definitions and hashes, without ROS.

The definitions of the messages that Foxglove draws over images stand here and in each recording, so
that neither writing nor reading one needs the ROS package foxglove_msgs.
"""

from __future__ import annotations

import struct
from functools import cache
from types import MappingProxyType
from typing import Any

from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from vehicle_pf_tracker.core.errors import InputError

IMAGE_ANNOTATIONS = "foxglove_msgs/msg/ImageAnnotations"

DEFINITIONS = MappingProxyType(
    {
        "foxglove_msgs/msg/Color": "float64 r\nfloat64 g\nfloat64 b\nfloat64 a\n",
        "foxglove_msgs/msg/Point2": "float64 x\nfloat64 y\n",
        "foxglove_msgs/msg/CircleAnnotation": (
            "builtin_interfaces/Time timestamp\n"
            "foxglove_msgs/Point2 position\n"
            "float64 diameter\n"
            "float64 thickness\n"
            "foxglove_msgs/Color fill_color\n"
            "foxglove_msgs/Color outline_color\n"
        ),
        "foxglove_msgs/msg/PointsAnnotation": (
            "builtin_interfaces/Time timestamp\n"
            "uint8 UNKNOWN=0\n"
            "uint8 POINTS=1\n"
            "uint8 LINE_LOOP=2\n"
            "uint8 LINE_STRIP=3\n"
            "uint8 LINE_LIST=4\n"
            "uint8 type\n"
            "foxglove_msgs/Point2[] points\n"
            "foxglove_msgs/Color outline_color\n"
            "foxglove_msgs/Color[] outline_colors\n"
            "foxglove_msgs/Color fill_color\n"
            "float64 thickness\n"
        ),
        "foxglove_msgs/msg/TextAnnotation": (
            "builtin_interfaces/Time timestamp\n"
            "foxglove_msgs/Point2 position\n"
            "string text\n"
            "float64 font_size\n"
            "foxglove_msgs/Color text_color\n"
            "foxglove_msgs/Color background_color\n"
        ),
        IMAGE_ANNOTATIONS: (
            "foxglove_msgs/CircleAnnotation[] circles\n"
            "foxglove_msgs/PointsAnnotation[] points\n"
            "foxglove_msgs/TextAnnotation[] texts\n"
        ),
    }
)
"""Definition by name of the type: the fields of ROS 2 Jazzy's foxglove_msgs."""


# rosbags before 0.11 lets what a broken message causes through as it is.
_BROKEN = (SerdeError, struct.error, ValueError, IndexError, AssertionError)
_HEADER_TYPES = {"std_msgs/Header", "std_msgs/msg/Header", "Header"}


@cache
def _store() -> Typestore:
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in DEFINITIONS.items():
        store.register(get_types_from_msg(text, name))
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


def starts_with_header(type_name: str, definition: str) -> bool:
    """Return whether a message begins with a `std_msgs/Header`, by its type or its `.msg` text."""
    known = _store().fielddefs.get(type_name)
    if known is not None:
        fields = known[1]
        return bool(fields) and fields[0][1][1] == "std_msgs/msg/Header"
    for line in definition.splitlines():
        words = line.partition("#")[0].split()
        if words and "=" not in line:
            return words[0] in _HEADER_TYPES
    return False


def header_stamp_ns(data: memoryview) -> int | None:
    """Read the stamp of a serialized message that begins with a header; None if it is too short."""
    if len(data) < 12:
        return None
    seconds, nanoseconds = struct.unpack_from("<iI" if data[1] & 1 else ">iI", data, 4)
    return int(seconds * 1_000_000_000 + nanoseconds)
