# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images as they came, read in place.

rclpy copies an image once more to make a message of it; here its pixels are a view of what came.
A recorder keeps that as it is, and need not serialize the message again.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import Final, TypeAlias

from builtin_interfaces.msg import Time
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from vehicle_pf_tracker.ros.reading import read_message

_LITTLE_ENDIAN: Final = b"\0\1"
"""Encapsulation of plain CDR with the lowest byte first, which all but exotic machines send."""
_BEGINNING: Final = struct.Struct("<iII")
"""Stamp in s and ns, and length of the frame's name."""
_SIZE: Final = struct.Struct("<III")
"""Height and width, px, and length of the encoding's name."""
_DATA: Final = struct.Struct("<II")
"""Bytes of a row, and of all."""


@dataclass(frozen=True, slots=True)
class SerializedImage:
    """An image with the fields of a `sensor_msgs/Image`, whose data is a part of what came.

    Attributes
    ----------
    header : Header
        Stamp and frame.
    height, width : int
        Size in px.
    encoding : str
        Layout of the pixels.
    is_bigendian : int
        1 where the high byte of a value comes first.
    step : int
        Bytes of a row.
    data : memoryview
        Bytes of all rows.
    serialized : bytes
        All that came, in CDR.
    """

    header: Header
    height: int
    width: int
    encoding: str
    is_bigendian: int
    step: int
    data: memoryview
    serialized: bytes


ImageMessage: TypeAlias = SerializedImage | Image | CompressedImage
"""Image as a node takes it; a `SerializedImage`, but for what that cannot read."""


def read_serialized_image(serialized: bytes) -> SerializedImage | Image:
    """Read a `sensor_msgs/Image` in CDR without a copy; in any other form by rclpy.

    Raises
    ------
    InputError
        If it is no image.
    """
    try:
        return _read(serialized)
    except (struct.error, ValueError):
        return read_message(serialized, Image)


def _read(serialized: bytes) -> SerializedImage:
    """Read plain CDR; ValueError or struct.error where it is something else."""
    if serialized[:2] != _LITTLE_ENDIAN:
        raise ValueError
    # Behind four bytes of encapsulation, numbers are aligned to their size; a string ends in a 0,
    # which counts.
    seconds, nanoseconds, length = _BEGINNING.unpack_from(serialized, 4)
    frame_id = serialized[16 : 15 + length].decode()
    at = _aligned(16 + length)
    height, width, length = _SIZE.unpack_from(serialized, at)
    at += _SIZE.size
    encoding = serialized[at : at + length - 1].decode()
    at += length
    is_bigendian = serialized[at : at + 1]
    at = _aligned(at + 1)
    step, size = _DATA.unpack_from(serialized, at)
    at += _DATA.size
    data = memoryview(serialized)[at : at + size]
    if len(data) != size:
        raise ValueError
    header = Header(stamp=Time(sec=seconds, nanosec=nanoseconds), frame_id=frame_id)
    return SerializedImage(header, height, width, encoding, is_bigendian[0], step, data, serialized)


def _aligned(offset: int) -> int:
    """Next offset at which a number of four bytes may stand."""
    return (offset + 3) & ~3
