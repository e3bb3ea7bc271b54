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

"""Image messages as frames, read in place.

Serialized `sensor_msgs/Image` messages are used where they lie: rclpy would copy the pixels of
every image again on their way into a message of Python.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.compressed_image import CodedImage, read_compressed
from vehicle_pf_tracker.image.encodings import to_rgb

_BODY = 4
"""Bytes before the message, the second of which tells the byte order."""


class _Layout(NamedTuple):
    """Numbers before the frame_id, before the encoding, and before the pixels."""

    stamp: struct.Struct
    size: struct.Struct
    step: struct.Struct


_LAYOUTS = [
    _Layout(*(struct.Struct(order + kinds) for kinds in ("iII", "III", "II"))) for order in "><"
]
"""For a big-endian and for a little-endian message."""


class SerializedImage(NamedTuple):
    """The fields of a `sensor_msgs/Image`; `data` is a view of the serialized message."""

    header: Header
    height: int
    width: int
    encoding: str
    is_bigendian: int
    step: int
    data: memoryview


def read_serialized(message: bytes) -> SerializedImage:
    """Read a `sensor_msgs/Image` in CDR, its encapsulation header included.

    Raises
    ------
    InputError
        If it is cut off.
    """
    try:
        layout = _LAYOUTS[message[1] & 1]
        seconds, nanoseconds, length = layout.stamp.unpack_from(message, _BODY)
        frame_id, at = _text(message, _BODY + 12, length)
        at = _aligned(at)
        height, width, length = layout.size.unpack_from(message, at)
        encoding, at = _text(message, at + 12, length)
        is_bigendian = message[at]
        at = _aligned(at + 1)
        step, size = layout.step.unpack_from(message, at)
    except (struct.error, IndexError):
        raise InputError("a serialized image is cut off before its pixels") from None
    data = memoryview(message)[at + 8 : at + 8 + size]
    header = Header()
    header.stamp.sec, header.stamp.nanosec, header.frame_id = seconds, nanoseconds, frame_id
    return SerializedImage(header, height, width, encoding, is_bigendian, step, data)


def read_image(message: Image | SerializedImage | CompressedImage) -> Frame | CodedImage:
    """Return the RGB frame of `message`; for rgb8 a view of its data.

    A compressed image is not decoded: it may be a stray, of any size.

    Raises
    ------
    InputError
        If the encoding is unknown, or size and data do not fit each other.
    """
    if isinstance(message, CompressedImage):
        return read_compressed(message.format, message.data)
    return to_rgb(
        message.encoding,
        message.height,
        message.width,
        message.step,
        bool(message.is_bigendian),
        message.data,
    )


def frame_of(image: Frame | CodedImage) -> Frame:
    """Return the pixels of an image that was used, and so is decoded already."""
    return image.decode() if isinstance(image, CodedImage) else image


def _text(message: bytes, at: int, length: int) -> tuple[str, int]:
    """Return the text of `length` bytes without its final zero, and the next field's offset."""
    text = message[at : at + max(length - 1, 0)]
    return text.decode("utf-8", "replace"), at + length


def _aligned(at: int) -> int:
    """Return the offset of the next four-byte number at or after `at`."""
    return at + -at % 4
