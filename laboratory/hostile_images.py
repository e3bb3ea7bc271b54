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

"""Measure what the dearest compressed images cost that are still decoded.

    python -m laboratory.hostile_images

Each kind of file is made as large as it may be; every one is decoded in a process of its own.
"""

from __future__ import annotations

import argparse
import struct
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.compressed_image import read_compressed

_SMALLER = 0.97
"""Factor on the side of the image after a refusal."""

_DECODE = """
import re, sys, time, numpy as np, cv2
from vehicle_pf_tracker.image.compressed_image import decode_compressed
cv2.setNumThreads(1)
decode_compressed("warm", cv2.imencode(".jpg", np.zeros((64, 64, 3), np.uint8))[1])
def peak(): return int(re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read())[1]) * 1024
data = np.fromfile(sys.argv[1], np.uint8)
before, began = peak(), time.process_time()
frame = decode_compressed("x", data)
print(time.process_time() - began, (peak() - before) / 1e6)
"""


def jpeg(width: int, height: int, *, is_noise: bool, options: tuple[int, ...]) -> bytes:
    """Make a JPEG of noise or of black."""
    picture = np.zeros((height, width, 3), np.uint8)
    if is_noise:
        picture = np.random.default_rng(0).integers(0, 255, picture.shape, np.uint8)
    return cv2.imencode(".jpg", picture, options)[1].tobytes()


def scanned(width: int, height: int, scans: int) -> bytes:
    """Make a black progressive JPEG whose last scan is repeated until it has so many."""
    data = jpeg(width, height, is_noise=False, options=PROGRESSIVE)
    last = data[data.rfind(b"\xff\xda") : -2]
    return data[:-2] + last * (scans - data.count(b"\xff\xda")) + data[-2:]


def png(width: int, height: int, *, depth: int, colour: int, noise: int, passes: int) -> bytes:
    """Make a PNG of rows with the dearest filter (Paeth), some of whose bytes are noise."""
    row = width * {2: 3, 6: 4}[colour] * depth // 8
    rows = [row] * height
    if passes:
        rows = [
            -(-(width - x) // dx) * row // width
            for x, y, dx, dy in png_passes()
            for _ in range(-(-(height - y) // dy))
        ]
    packer = zlib.compressobj(1, strategy=zlib.Z_HUFFMAN_ONLY if noise else zlib.Z_DEFAULT_STRATEGY)
    draws = np.random.default_rng(0).integers(0, max(noise, 1), 2 * row, np.uint8).tobytes()
    parts = [packer.compress(b"\4" + draws[at % row :][:length]) for at, length in enumerate(rows)]
    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, passes)
    pixels = b"".join([*parts, packer.flush()])
    chunks = ((b"IHDR", header), (b"IDAT", pixels), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(kind, body) for kind, body in chunks)


def png_passes() -> tuple[tuple[int, int, int, int], ...]:
    """First column and row, and steps, of the seven passes of an interlaced PNG."""
    return (
        (0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2),
        (0, 1, 1, 2),
    )  # fmt: skip


def chunk(kind: bytes, body: bytes) -> bytes:
    """Frame a chunk of a PNG."""
    checked = kind + body
    return len(body).to_bytes(4, "big") + checked + zlib.crc32(checked).to_bytes(4, "big")


PROGRESSIVE = (cv2.IMWRITE_JPEG_PROGRESSIVE, 1)
_ALL_COLOUR = (cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444)
_FINE = (cv2.IMWRITE_JPEG_QUALITY, 100, *_ALL_COLOUR)
Maker = Callable[[int, int], bytes]
KINDS: dict[str, Maker] = {
    "JPEG, black": lambda w, h: jpeg(w, h, is_noise=False, options=()),
    "JPEG, noise": lambda w, h: jpeg(w, h, is_noise=True, options=()),
    "JPEG, noise, quality 100": lambda w, h: jpeg(w, h, is_noise=True, options=_FINE),
    "progressive, black": lambda w, h: jpeg(w, h, is_noise=False, options=PROGRESSIVE),
    "progressive, noise": lambda w, h: jpeg(w, h, is_noise=True, options=PROGRESSIVE),
    "progressive, noise, quality 100": lambda w, h: jpeg(
        w, h, is_noise=True, options=(*PROGRESSIVE, *_FINE)
    ),
    "progressive, 100 scans": lambda w, h: scanned(w, h, 100),
    "progressive, 2000 scans": lambda w, h: scanned(w, h, 2000),
    "PNG, black": lambda w, h: png(w, h, depth=8, colour=2, noise=0, passes=0),
    "PNG, noise": lambda w, h: png(w, h, depth=8, colour=2, noise=256, passes=0),
    "PNG, little noise": lambda w, h: png(w, h, depth=8, colour=2, noise=40, passes=0),
    "PNG, 16 bits and alpha": lambda w, h: png(w, h, depth=16, colour=6, noise=40, passes=0),
    "PNG, interlaced": lambda w, h: png(w, h, depth=8, colour=6, noise=40, passes=1),
}


def largest(make: Maker, side: float) -> tuple[bytes, tuple[int, int]]:
    """Make the largest file of a kind that is taken, of 16:9."""
    while True:
        size = round(side), round(side * 9 / 16)
        data = make(*size)
        try:
            read_compressed("x", data)
        except InputError:
            side *= _SMALLER
            continue
        return data, size


def main() -> None:
    """Measure each kind and print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--side", type=float, default=8000, help="width in px to begin with")
    parser.add_argument("kinds", nargs="*", help="measure these alone")
    args = parser.parse_args()
    print("| file | size (px) | MB | CPU (s) | memory (MB) |\n|---|---|---|---|---|")
    for name, make in KINDS.items():
        if args.kinds and name not in args.kinds:
            continue
        data, (width, height) = largest(make, args.side)
        with tempfile.NamedTemporaryFile() as file:
            Path(file.name).write_bytes(data)
            words = [sys.executable, "-c", _DECODE, file.name]
            told = subprocess.run(words, capture_output=True, text=True, check=True).stdout
        seconds, memory = map(float, told.split())
        cells = f"{width}x{height} | {len(data) / 1e6:.1f} | {seconds:.2f} | {memory:.0f}"
        print(f"| {name} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
