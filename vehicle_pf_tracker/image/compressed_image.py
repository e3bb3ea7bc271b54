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

"""JPEG and PNG images as RGB frames, whose size is known before anything is decoded.

A file of a few bytes may claim a picture, or a chunk, of gigabytes, for which OpenCV would allocate
memory. So lengths are checked and the size is read first, in the way of the decoders behind it
(libjpeg's `next_marker`, the chunks of a PNG one after the other), and what is too large, or longer
than its data, never gets to them.
"""

from __future__ import annotations

import cv2

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.encodings import MAX_SIDE, Buffer, Bytes, flat_bytes

MAX_PIXELS = 100_000_000
"""Three times those of 8K video; as a frame 300 MB."""

MAX_SCANS = 64
"""Scans of a JPEG; progressive ones have about ten. Each may cost 0.55 ns per pixel however few
bytes it has, so that 64 over the largest image of several scans take 0.8 s."""

MAX_SCANNED_PIXELS = 24_000_000
"""Of a JPEG of several scans, whose decoder keeps 6.7 bytes for each pixel: 160 MB."""

_PNG, _JPEG = b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"
_CHUNK_FRAME = 12
"""Length, kind and checksum around the data of a chunk."""
_FILL, _START_OF_SCAN, _END = 0xFF, 0xDA, 0xD9
_ALONE = frozenset({0x01, *range(0xD0, 0xD9)})
"""Markers without a length: TEM, restarts and the start of the image."""
_FRAME_HEADERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
"""SOF0 to SOF15: the same range holds DHT, JPG and DAC."""


def decode_compressed(format: str, data: Buffer) -> Frame:  # noqa: A002 (the ROS field's name)
    """Decode the data of a `sensor_msgs/CompressedImage` (JPEG or PNG) to an RGB frame.

    Parameters
    ----------
    format : str
        The message's format, for the error only: the data identify themselves.
    data : buffer
        The file's bytes.

    Raises
    ------
    InputError
        If the data are empty, cut off, neither JPEG nor PNG, or damaged, or if they claim a side
        above `MAX_SIDE` or more than `MAX_PIXELS` pixels.
    """
    coded = flat_bytes(data)
    name = f"a compressed image (format {format!r})"
    if coded.size == 0:
        raise InputError(f"{name} holds no data")
    width, height = _size_of(name, coded.tobytes())
    if max(width, height) > MAX_SIDE or width * height > MAX_PIXELS:
        raise InputError(
            f"{name} claims {width}x{height} px, above the {MAX_PIXELS // 10**6} megapixels and "
            f"{MAX_SIDE} px a side that are read; is it broken?"
        )
    _check_scans(name, coded.tobytes(), width * height)
    return _decoded(name, coded)


def _check_scans(name: str, data: bytes, pixels: int) -> None:
    """Refuse a JPEG whose scans would keep the decoder busy for long; PNG has none."""
    # Within coded pixels every 255 is followed by 0, so that only metadata can be counted besides.
    scans = data.count(b"\xff\xda") if data.startswith(_JPEG) else 1
    if scans > MAX_SCANS:
        raise InputError(f"{name} has {scans} scans, above the {MAX_SCANS} that are read")
    if scans > 1 and pixels > MAX_SCANNED_PIXELS:
        raise InputError(
            f"{name} has several scans and {pixels / 1e6:.0f} megapixels, above the "
            f"{MAX_SCANNED_PIXELS // 10**6} that are read of such"
        )


def _size_of(name: str, data: bytes) -> tuple[int, int]:
    if data.startswith(_PNG):
        is_cut, read_size = _is_cut_png, _png_size
    elif data.startswith(_JPEG):
        is_cut, read_size = _is_cut_jpeg, _jpeg_size
    else:
        raise InputError(f"{name} is neither JPEG nor PNG")
    if is_cut(data):
        raise InputError(f"{name} is cut off before its end")
    size = read_size(data)
    if size is None:
        raise InputError(f"{name} cannot be decoded: it does not state its size")
    return size


def _decoded(name: str, coded: Bytes) -> Frame:
    try:
        image = cv2.imdecode(coded, cv2.IMREAD_COLOR)
    except cv2.error:
        image = None
    if image is None:
        raise InputError(f"{name} cannot be decoded: its data are damaged")
    return cv2.cvtColor(image, cv2.COLOR_BGR2RGB, dst=image)  # type: ignore[return-value]


def _is_cut_png(data: bytes) -> bool:
    """Test whether a PNG lacks its last chunk, or has a chunk that is longer than the data."""
    offset = len(_PNG)
    while offset + _CHUNK_FRAME <= len(data):
        kind = data[offset + 4 : offset + 8]
        offset += _CHUNK_FRAME + int.from_bytes(data[offset : offset + 4], "big")
        if kind == b"IEND":
            return offset > len(data)
    return True


def _png_size(data: bytes) -> tuple[int, int] | None:
    """Width and height in the first chunk; None if that is another one than the header."""
    header = data[len(_PNG) :]
    if header[4:8] != b"IHDR":
        return None
    return int.from_bytes(header[8:12], "big"), int.from_bytes(header[12:16], "big")


def _jpeg_size(data: bytes) -> tuple[int, int] | None:
    """Width and height of the first frame header; None if the pixels begin without one."""
    offset = 2
    while True:
        offset = data.find(_FILL, offset)
        if offset < 0:
            return None
        while data[offset : offset + 1] == b"\xff":
            offset += 1
        marker, offset = data[offset : offset + 1], offset + 1
        if not marker or marker[0] in (_START_OF_SCAN, _END):
            return None
        if marker[0] in _FRAME_HEADERS:
            return _frame_size(data[offset : offset + 7])
        if marker[0] != 0 and marker[0] not in _ALONE:  # 0: no marker, but an escaped 255
            offset += int.from_bytes(data[offset : offset + 2], "big")


def _frame_size(header: bytes) -> tuple[int, int] | None:
    """Read what stands behind a frame header's marker: length, precision, height, width."""
    if len(header) < 7:
        return None
    return int.from_bytes(header[5:7], "big"), int.from_bytes(header[3:5], "big")


def _is_cut_jpeg(data: bytes) -> bool:
    """Test whether a JPEG has no end marker, which its decoder would fill up with grey.

    The marker cannot occur within the coded pixels; a thumbnail has its own in the first half.
    """
    return data.find(b"\xff\xd9", len(data) // 2) < 0
