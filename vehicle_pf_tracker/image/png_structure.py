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

"""Structure of a PNG file: its size, and whether its data are those of such an image."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass

SIGNATURE = b"\x89PNG\r\n\x1a\n"

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
    offset, view = len(SIGNATURE), memoryview(data)
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
