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

The definitions of the messages that Foxglove draws over images, the fields of ROS 2 Jazzy's
foxglove_msgs, stand in ImageAnnotations.msg and in each recording, so that neither writing nor
reading one needs that ROS package.
"""

from __future__ import annotations

import struct
from functools import cache
from importlib import resources
from typing import Any

from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from vehicle_pf_tracker.core.errors import InputError

IMAGE_ANNOTATIONS = "foxglove_msgs/msg/ImageAnnotations"

# rosbags before 0.11 lets what a broken message causes through as it is.
_BROKEN = (SerdeError, struct.error, ValueError, IndexError, AssertionError)


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


def header_stamp_ns(data: memoryview) -> int | None:
    """Read the stamp of a serialized message that begins with a header; None if it is too short."""
    if len(data) < 12:
        return None
    seconds, nanoseconds = struct.unpack_from("<iI" if data[1] & 1 else ">iI", data, 4)
    return int(seconds * 1_000_000_000 + nanoseconds)
