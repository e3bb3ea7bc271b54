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

"""Structure of JPEG and PNG files, read without decoding a pixel.

A JPEG is read by its markers; a PNG by its chunks, and its data inflate to those of its size or do
not.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field

JPEG_SIGNATURE = b"\xff\xd8\xff"

_FILL, _START_OF_SCAN, _END, _RESTART_INTERVAL = 0xFF, 0xDA, 0xD9, 0xDD
_ALONE = frozenset({0x01, *range(0xD0, 0xD9)})
"""Markers without a length: TEM, restarts and the start of the image."""
_FRAME_HEADERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
"""SOF0 to SOF15: the same range holds DHT, JPG and DAC."""

_BLOCK = 8
"""Side of a block of coefficients in px."""
_COEFFICIENTS = 64

# Within coded pixels every 255 is followed by 0 or a restart's number.
_AFTER_SCAN = re.compile(rb"\xff+[^\x00\xd0-\xd7\xff]")
_RESTART = re.compile(rb"\xff[\xd0-\xd7]")


@dataclass(frozen=True, slots=True)
class _Scan:
    """One pass over the pixels: its components, its coefficients, and how often it restarts."""

    components: tuple[int, ...]
    first: int
    last: int
    low_bit: int
    restarts: int


@dataclass(slots=True)
class JpegStructure:
    """Markers of a JPEG up to the end of its image.

    Attributes
    ----------
    kind : int or None
        Number of the frame header (SOF0: 0, baseline; 2: progressive); None without one.
    width, height : int
        Size in px, before the file's orientation is applied.
    scans : list
        Passes over the pixels, in order.
    end : int or None
        Offset behind the end marker; None if there is none. Padding may follow.
    """

    kind: int | None = None
    width: int = 0
    height: int = 0
    scans: list[_Scan] = field(default_factory=list)
    end: int | None = None
    _sampling: dict[int, tuple[int, int]] = field(default_factory=dict)
    _interval: int = 0

    @property
    def is_progressive(self) -> bool:
        """True where the coefficients come in several passes."""
        return self.kind == 2

    @property
    def lacks_scans(self) -> bool:
        """True where coefficients of a component, or bits of them, are in no scan."""
        lowest = {name: [1] * _COEFFICIENTS for name in self._sampling}
        for scan in self.scans:
            for name in scan.components:
                count = len(range(scan.first, scan.last + 1))
                lowest.setdefault(name, [1] * _COEFFICIENTS)[scan.first : scan.last + 1] = [
                    scan.low_bit
                ] * count
        return any(map(any, lowest.values()))

    @property
    def lacks_restarts(self) -> bool:
        """True where a JPEG of one scan has fewer restarts than its size asks for."""
        if not self._interval or len(self.scans) != 1:
            return False
        across = _BLOCK * max((one for one, _ in self._sampling.values()), default=1)
        down = _BLOCK * max((one for _, one in self._sampling.values()), default=1)
        if len(self._sampling) == 1:
            across = down = _BLOCK
        units = -(-self.width // across) * -(-self.height // down)
        return self.scans[0].restarts < -(-units // self._interval) - 1

    def _read_frame_header(self, kind: int, body: bytes) -> None:
        self.kind = kind
        self.height, self.width = (int.from_bytes(body[at : at + 2], "big") for at in (1, 3))
        for at in range(6, len(body) - 2, 3):
            self._sampling[body[at]] = body[at + 1] >> 4, body[at + 1] & 15

    def _read_scan(self, body: bytes, coded: bytes) -> None:
        count = body[0] if body else 0
        first, last, bits = (body[1 + 2 * count : 4 + 2 * count] + bytes(3))[:3]
        if not self.is_progressive:
            first, last, bits = 0, _COEFFICIENTS - 1, 0
        self.scans.append(
            _Scan(
                components=tuple(body[1 : 1 + 2 * count : 2]),
                first=first,
                last=min(last, _COEFFICIENTS - 1),
                low_bit=bits & 15,
                restarts=len(_RESTART.findall(coded)) if self._interval else 0,
            )
        )


def read_jpeg_structure(data: bytes) -> JpegStructure:
    """Read the markers of `data` in the way of libjpeg's `next_marker`, up to the end marker."""
    structure = JpegStructure()
    offset = 2
    while (found := _next_marker(data, offset)) is not None:
        marker, offset = found
        if marker == _END:
            structure.end = offset
            break
        if marker in _ALONE:
            continue
        length = int.from_bytes(data[offset : offset + 2], "big")
        body, offset = data[offset + 2 : offset + length], offset + max(length, 2)
        if marker in _FRAME_HEADERS and structure.kind is None and len(body) >= 6:
            structure._read_frame_header(marker - 0xC0, body)
        elif marker == _RESTART_INTERVAL:
            structure._interval = int.from_bytes(body[:2], "big")
        elif marker == _START_OF_SCAN:
            after = _AFTER_SCAN.search(data, offset)
            end = after.start() if after else len(data)
            structure._read_scan(body, data[offset:end])
            offset = end
    return structure


def _next_marker(data: bytes, offset: int) -> tuple[int, int] | None:
    """Find the next marker, and where its segment begins; None if there is none."""
    while True:
        offset = data.find(_FILL, offset)
        if offset < 0:
            return None
        while data[offset : offset + 1] == b"\xff":
            offset += 1
        if offset >= len(data):
            return None
        if data[offset]:  # 0: no marker, but an escaped 255
            return data[offset], offset + 1


PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"

_FRAME = 12
"""Length, kind and checksum around the data of a chunk, in bytes."""
_HEADER = 13

_KEPT = frozenset({b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"eXIf", b"IEND"})
"""Chunks that say which pixels there are, and how the camera was turned. Decoders inflate others
too: 900 compressed comments of 8 kB each become 7 GB."""

_CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
"""Samples of a pixel by colour type."""

_PASSES = (
    (0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2),
    (0, 1, 1, 2),
)  # fmt: skip
"""First column and row, and steps to the next ones, of the passes of an interlaced image."""

_PIECE = 2**16
"""Bytes that are inflated at a time, so that counting them takes no memory."""


@dataclass(frozen=True, slots=True)
class PngStructure:
    """Header of a PNG, and its bytes without what its pixels do not need.

    Attributes
    ----------
    width, height : int
        Size in px, before the file's orientation is applied.
    raw_bytes : int
        Bytes that its pixels inflate to; 0 for a kind of image that there is not.
    needed : bytes
        The file without other chunks.
    pixels : tuple of memoryview
        The deflated pixels.
    """

    width: int
    height: int
    raw_bytes: int
    needed: bytes
    pixels: tuple[memoryview, ...]

    def inflates_to_its_size(self) -> bool:
        """Test whether the deflated pixels are as many as the header says.

        Decoders inflate what follows them too: 3 MB may cost seconds.
        """
        inflation, count = zlib.decompressobj(), 0
        try:
            for piece in self._pieces():
                left: bytes | memoryview = piece
                while left and not inflation.eof and count <= self.raw_bytes:
                    count += len(inflation.decompress(left, _PIECE))
                    left = inflation.unconsumed_tail
        except zlib.error:
            return False
        return inflation.eof and count == self.raw_bytes

    def _pieces(self) -> Iterator[memoryview]:
        for part in self.pixels:
            for begin in range(0, len(part), _PIECE):
                yield part[begin : begin + _PIECE]


def read_png_structure(data: bytes) -> PngStructure | None:
    """Read the chunks of `data`; None if the last one is missing, or a chunk is cut off."""
    offset, view = len(PNG_SIGNATURE), memoryview(data)
    needed, pixels, header = [view[:offset]], [], b""
    while offset + _FRAME <= len(data):
        length, kind = (
            int.from_bytes(data[offset : offset + 4], "big"),
            data[offset + 4 : offset + 8],
        )
        begin, offset = offset, offset + _FRAME + length
        if offset > len(data):
            return None
        body = view[begin + 8 : offset - 4]
        if kind in _KEPT:
            needed.append(view[begin:offset])
        if kind == b"IDAT":
            pixels.append(body)
        if len(needed) == 2 and kind == b"IHDR" and length == _HEADER:
            header = bytes(body)
        if kind == b"IEND":
            size = int.from_bytes(header[:4], "big"), int.from_bytes(header[4:8], "big")
            return PngStructure(*size, _raw_bytes(header), b"".join(needed), tuple(pixels))
    return None


def _raw_bytes(header: bytes) -> int:
    if not header:
        return 0
    width, height = int.from_bytes(header[:4], "big"), int.from_bytes(header[4:8], "big")
    depth, colour, interlaced = header[8], header[9], header[12]
    bits = depth * _CHANNELS.get(colour, 0)
    passes = _PASSES if interlaced else ((0, 0, 1, 1),)
    count = 0
    for left, top, step_x, step_y in passes:
        columns, rows = -(-(width - left) // step_x), -(-(height - top) // step_y)
        if columns > 0 and rows > 0:
            count += rows * (1 + -(-columns * bits // 8))
    return count if bits else 0
