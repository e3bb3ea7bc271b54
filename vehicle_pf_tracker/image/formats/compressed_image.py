# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""JPEG and PNG images as RGB frames, whose size is known before anything is decoded.

A file of a few bytes may claim a picture of gigabytes, and a decoder fills up with grey what is cut
off. So the markers of a JPEG and the chunks of a PNG are read first, up to the end.
"""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, field

import cv2
import numpy as np

from vehicle_pf_tracker.core.errors import InputError, brief
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.formats.encodings import LARGEST_SIDE_PX, Buffer, flat_bytes

MAX_PIXELS = 30_000_000
"""Three and a half times those of 4K video; decoding so many takes some 200 MB."""

_JPEG = b"\xff\xd8\xff"
_PNG = b"\x89PNG\r\n\x1a\n"

_MARKER = re.compile(rb"\xff+([^\x00\xff])")
"""Marker of a JPEG; within coded pixels every 255 is followed by 0 or a restart's number."""
_END = 0xD9
"""EOI, after which drivers may pad."""
_ALONE = frozenset({0x01, *range(0xD0, 0xD9)})
"""Markers without a length: TEM, restarts and the start of the image."""
_FRAME_HEADERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
"""SOF0 to SOF15: the same range holds DHT, JPG and DAC."""


@dataclass(slots=True)
class CodedImage:
    """A JPEG or PNG that may be decoded, of a size that its header states.

    Attributes
    ----------
    name : str
        Name in errors.
    size : (int, int)
        Width and height in px, before the file's orientation is applied.
    """

    name: str
    size: tuple[int, int]
    _data: bytes
    _frame: Frame | None = field(default=None, init=False)

    def decode(self) -> Frame:
        """Decode it to an RGB frame; once, however often it is asked for.

        Raises
        ------
        InputError
            If it is damaged.
        """
        # Decoded late: the node looks at the size first, and a stray is never decoded.
        if self._frame is None:
            image = None
            with suppress(cv2.error):
                image = cv2.imdecode(np.frombuffer(self._data, np.uint8), cv2.IMREAD_COLOR)
            if image is None:
                raise InputError(f"{self.name} cannot be decoded: its data are damaged")
            self._frame = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB, dst=image), np.uint8)
        return self._frame


def decode_compressed(format: str, data: Buffer) -> Frame:  # noqa: A002 (the ROS field's name)
    """Decode the data of a `sensor_msgs/CompressedImage` (JPEG or PNG) to an RGB frame.

    Parameters and errors are those of `read_compressed` and of `CodedImage.decode`.
    """
    return read_compressed(format, data).decode()


def read_compressed(format: str, data: Buffer) -> CodedImage:  # noqa: A002
    """Read the size of a `sensor_msgs/CompressedImage`, without decoding it.

    Parameters
    ----------
    format : str
        The message's format, for the error only: the data identify themselves.
    data : buffer
        The file's bytes.

    Raises
    ------
    InputError
        If the data are empty, cut off, neither JPEG nor PNG, or if they claim a side above
        `LARGEST_SIDE_PX` or more than `MAX_PIXELS` pixels.
    """
    name = f"a compressed image (format {brief(format)})"
    # Copied: the image may be decoded after the message is gone.
    coded = flat_bytes(data).tobytes()
    if not coded:
        raise InputError(f"{name} holds no data")
    if coded.startswith(_PNG):
        width, height, end = _png_size(coded)
    elif coded.startswith(_JPEG):
        width, height, end = _jpeg_size(coded)
    else:
        raise InputError(f"{name} is neither JPEG nor PNG")
    # First: one that is cut off may lack its size for that reason alone.
    if not end:
        raise InputError(f"{name} is cut off before its end")
    if not width:
        raise InputError(f"{name} cannot be decoded: it does not state its size")
    if max(width, height) > LARGEST_SIDE_PX or width * height > MAX_PIXELS:
        raise InputError(
            f"{name} claims {width}x{height} px, above the {MAX_PIXELS // 10**6} megapixels and "
            f"{LARGEST_SIDE_PX} px a side that are read; is it broken?"
        )
    return CodedImage(name, (width, height), coded[:end])


def _png_size(data: bytes) -> tuple[int, int, int]:
    """Width, height (0: not stated), and offset behind the last chunk (0: there is none)."""
    offset = len(_PNG)
    size = (0, 0)
    # A chunk is its length, kind, data and checksum: the loop ends at one that is cut off.
    while (end := offset + 12 + _number(data[offset : offset + 4])) <= len(data):
        kind = data[offset + 4 : offset + 8]
        if kind == b"IHDR" and end == offset + 25 and size == (0, 0):
            size = _number(data[offset + 8 : offset + 12]), _number(data[offset + 12 : offset + 16])
        if kind == b"IEND":
            return *size, end
        offset = end
    return *size, 0


def _jpeg_size(data: bytes) -> tuple[int, int, int]:
    """Width, height (0: not stated), and offset behind the end marker (0: there is none)."""
    offset = 2
    size = (0, 0)
    # By lengths from marker to marker: thumbnails in segments have markers, too.
    while match := _MARKER.search(data, offset):
        marker = match[1][0]
        offset = match.end()
        if marker == _END:
            return *size, offset
        if marker in _ALONE:
            continue
        length = _number(data[offset : offset + 2])
        # The first header counts: a thumbnail in a later segment has another size.
        if marker in _FRAME_HEADERS and size == (0, 0) and length >= 8:
            size = _number(data[offset + 5 : offset + 7]), _number(data[offset + 3 : offset + 5])
        offset += max(length, 2)
    return *size, 0


def _number(data: bytes) -> int:
    return int.from_bytes(data, "big")


def jpeg(frame: Frame, quality: int = 95) -> bytes:
    """Code an RGB frame as a JPEG file; at OpenCV's default quality, 95 %, edges stay sharp."""
    image = cv2.cvtColor(frame, cv2.COLOR_RGB2BGR)
    _, coded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return coded.tobytes()
