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

"""JPEG and PNG images as RGB frames, whose size and cost are known before anything is decoded.

A file of a few bytes may claim a picture, or a chunk, of gigabytes, for which a decoder would
allocate memory, or take minutes. So the structure is read first, in the way of the decoders behind
it, and what costs too much, or is cut off, never gets to them: an image costs at most a second of
CPU time and 200 MB.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image import compressed_structure
from vehicle_pf_tracker.image.compressed_structure import (
    JpegStructure,
    PngStructure,
    read_jpeg_structure,
    read_png_structure,
)
from vehicle_pf_tracker.image.encodings import MAX_SIDE, Buffer, flat_bytes

MAX_PIXELS = 30_000_000
"""Three and a half times those of 4K video."""

MAX_SECONDS = 1.0
MAX_BYTES = 200_000_000
"""CPU time and memory to decode one image, by the costs below."""

# Of the dearest files that were made for it: laboratory/hostile_images.py. By them a camera's JPEG
# of 4K takes 0.1 s.
_PIXEL, _BYTE = 12e-9, 9e-9
_SCANNED_PIXEL, _SCANNED_BYTE = 7e-9, 35e-9
_SCAN = 0.7e-9
"""Seconds for a pixel and for a byte of a JPEG of one scan, of one of several scans, and for a
pixel in each scan, however few bytes that has."""
_RAW_BYTE, _PACKED_BYTE = 12e-9, 8e-9
"""Seconds for an inflated byte of a PNG and a deflated one, which is inflated twice: once to see
that it ends."""
_FRAME_BYTES, _SCANNED_BYTES, _COPIES = 6, 6, 2
"""Bytes of memory for a pixel: two frames in OpenCV 5, and what a JPEG of several scans keeps
besides. Copies of the file."""

_KINDS = frozenset({0, 1, 2})
"""Frame headers of the JPEGs that cameras write: baseline, extended, progressive. Others are
arithmetic, lossless or hierarchical coding, which few decoders read."""

_GREY = 128
"""Value of every channel where a decoder of JPEG has no data."""
_EXTRA = bytes(1 + (37 * at + at * at) % 254 for at in range(256))
"""Bytes that decode to anything but grey, with no marker among them."""


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
    _structure: JpegStructure | PngStructure
    _frame: Frame | None = field(default=None, init=False)

    def decode(self) -> Frame:
        """Decode it to an RGB frame; once, however often it is asked for.

        Raises
        ------
        InputError
            If it is damaged or cut off.
        """
        if self._frame is None:
            self._frame = self._decoded()
        return self._frame

    def _decoded(self) -> Frame:
        structure = self._structure
        if isinstance(structure, PngStructure) and not structure.inflates_to_its_size():
            raise InputError(f"{self.name} cannot be decoded: its data are damaged")
        image = _decoded(self._data)
        if image is None:
            raise InputError(f"{self.name} cannot be decoded: its data are damaged")
        if isinstance(structure, JpegStructure) and _ends_early(structure, self._data, image):
            raise InputError(f"{self.name} is cut off before its end")
        return _to_rgb(image)


def decode_compressed(format: str, data: Buffer) -> Frame:  # noqa: A002 (the ROS field's name)
    """Decode the data of a `sensor_msgs/CompressedImage` (JPEG or PNG) to an RGB frame.

    Parameters and errors are those of `read_compressed` and of `CodedImage.decode`.
    """
    return read_compressed(format, data).decode()


def read_compressed(format: str, data: Buffer) -> CodedImage:  # noqa: A002
    """Read the structure of a `sensor_msgs/CompressedImage`, without decoding it.

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
        `MAX_SIDE`, more than `MAX_PIXELS` pixels, or take more than `MAX_SECONDS` to decode.
    """
    name = f"a compressed image (format {format!r})"
    coded = flat_bytes(data).tobytes()
    if not coded:
        raise InputError(f"{name} holds no data")
    if coded.startswith(compressed_structure.PNG_SIGNATURE):
        return _read_png(name, coded)
    if coded.startswith(compressed_structure.JPEG_SIGNATURE):
        return _read_jpeg(name, coded)
    raise InputError(f"{name} is neither JPEG nor PNG")


def _read_png(name: str, data: bytes) -> CodedImage:
    png = read_png_structure(data)
    if png is None:
        raise InputError(f"{name} is cut off before its end")
    size = png.width, png.height
    if not png.raw_bytes:
        raise InputError(f"{name} cannot be decoded: it does not state its size")
    seconds = png.raw_bytes * _RAW_BYTE + len(data) * _PACKED_BYTE
    _check_cost(name, size, seconds, _memory(size, data))
    return CodedImage(name, size, png.needed, png)


def _read_jpeg(name: str, data: bytes) -> CodedImage:
    jpeg = read_jpeg_structure(data)
    if jpeg.end is None:
        raise InputError(f"{name} is cut off before its end")
    if jpeg.kind is None:
        raise InputError(f"{name} cannot be decoded: it does not state its size")
    if jpeg.kind not in _KINDS:
        raise InputError(f"{name} is a JPEG of a kind that is not read (SOF{jpeg.kind})")
    size, pixels, scans = (jpeg.width, jpeg.height), jpeg.width * jpeg.height, len(jpeg.scans)
    seconds, memory = pixels * _PIXEL + len(data) * _BYTE, _memory(size, data)
    if scans > 1:
        seconds = pixels * (_SCANNED_PIXEL + scans * _SCAN) + len(data) * _SCANNED_BYTE
    if scans > 1 or jpeg.is_progressive:
        memory += pixels * _SCANNED_BYTES
    _check_cost(name, size, seconds, memory)
    if jpeg.lacks_scans or jpeg.lacks_restarts:
        raise InputError(f"{name} is cut off before its end")
    return CodedImage(name, size, data[: jpeg.end], jpeg)


def _memory(size: tuple[int, int], data: bytes) -> int:
    return size[0] * size[1] * _FRAME_BYTES + len(data) * _COPIES


def _check_cost(name: str, size: tuple[int, int], seconds: float, memory: int) -> None:
    width, height = size
    if max(width, height) > MAX_SIDE or width * height > MAX_PIXELS:
        raise InputError(
            f"{name} claims {width}x{height} px, above the {MAX_PIXELS // 10**6} megapixels and "
            f"{MAX_SIDE} px a side that are read; is it broken?"
        )
    if seconds > MAX_SECONDS or memory > MAX_BYTES:
        raise InputError(
            f"{name} of {width}x{height} px would take {seconds:.1f} s and {memory / 1e6:.0f} MB, "
            f"above the {MAX_SECONDS:g} s and {MAX_BYTES // 10**6} MB that an image may; is it "
            "broken?"
        )


def _decoded(data: bytes) -> Frame | None:
    try:
        image: Frame | None = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)  # type: ignore[assignment]
    except cv2.error:
        return None
    return image


def _ends_early(jpeg: JpegStructure, data: bytes, image: Frame) -> bool:
    """Test whether the pixels end before the image does, and the decoder filled it up with grey.

    It says so on stderr alone. So, where the last block is grey, more data are put before the end:
    a whole image does not change by them.
    """
    turned = (image, image[::-1], image[:, ::-1], image[::-1, ::-1])  # by the file's orientation
    is_grey = any((_last_block(one) == _GREY).all() for one in turned)
    if jpeg.is_progressive or not (is_grey or len(jpeg.scans) > 1):
        return False
    longer = _decoded(data[:-2] + _EXTRA + data[-2:])
    return longer is None or not np.array_equal(image, longer)


def _last_block(image: Frame) -> Frame:
    """View of the last block of a JPEG, or of the last but one where that is one pixel wide.

    Without its first row and column, which take colour from the blocks before.
    """
    ends = [size - (size % 8 == 1) for size in image.shape[:2]]
    (bottom, rows), (right, columns) = ((end, min((end - 1) % 8, 4)) for end in ends)
    return image[max(bottom - max(rows, 1), 0) : bottom, max(right - max(columns, 1), 0) : right]


def _to_rgb(image: Frame) -> Frame:
    """Swap the channels in place, in bands: OpenCV copies what it converts in place."""
    rows = max(2**20 // (3 * image.shape[1]), 1)
    for top in range(0, image.shape[0], rows):
        band = image[top : top + rows]
        cv2.cvtColor(band, cv2.COLOR_BGR2RGB, dst=band)
    return image
