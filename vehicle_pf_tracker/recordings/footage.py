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

"""Images with their times, as any source yields them, and footage with its truth."""

from __future__ import annotations

import csv
import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Occlusion, Truth

START_NS = 1_000_000_000
"""Stamp of the first image. Not 0, which many ROS programs take for "no time"."""
LOWEST_FPS, HIGHEST_FPS = 1e-4, 1e6
"""Frame rates that are believed, 1/s: from an image every three hours up to one per microsecond,
which the fastest cameras reach."""
LARGEST_PX = 2.0**24
"""Largest coordinate of a true box, px: beyond it a polygon's single precision loses whole px."""
LAST_STAMP_NS = (2**31 - 1) * 10**9
"""Last stamp: `builtin_interfaces/Time` has a signed 32-bit number of seconds."""


@dataclass(frozen=True, slots=True)
class StampedFrame:
    """An image and the stamp of its header in ns; no frame where it cannot be read."""

    stamp_ns: int
    frame: Frame | None


@dataclass(frozen=True, slots=True)
class Picture(StampedFrame):
    """One image of the footage.

    Attributes
    ----------
    frame : Frame
        Pixels of the image.
    name : str
        Name of the image in an error.
    coded_format : str or None
        ``jpeg`` or ``png`` where it comes as such a file; else None.
    coded : bytes
        The bytes of that file.
    truth : Truth or None
        True state of the vehicle; None where it is unknown.
    """

    frame: Frame
    name: str
    coded_format: str | None = None
    coded: bytes = b""
    truth: Truth | None = None


class Footage(ABC):
    """Images of a video file, a folder, a camera or a stream; a source without topics.

    Attributes
    ----------
    fps : float
        Frames per second.
    frame_count : int or None
        Number of images; None where it is unknown.
    """

    image_topic = ""
    fps: float
    frame_count: int | None

    @abstractmethod
    def frames(self) -> Iterator[Picture]:
        """Yield the images in the order of time.

        Raises
        ------
        InputError
            If one is broken.
        """

    def truth(self) -> Sequence[Truth]:
        """Return the truth that is known before the images are read, in the order of time."""
        return ()

    @property
    def notices(self) -> list[str]:
        """Irregularities, a sentence each; complete when all images are read."""
        return []


def check_fps(fps: float, source: Path | str) -> float:
    """Return the frame rate that `source` states, in 1/s.

    Raises
    ------
    InputError
        If it is not between `LOWEST_FPS` and `HIGHEST_FPS`.
    """
    if not LOWEST_FPS <= fps <= HIGHEST_FPS:
        raise InputError(
            f"the frame rate (fps) in {source} must be a number from {LOWEST_FPS:g} to "
            f"{HIGHEST_FPS:g} frames per second"
        )
    return float(fps)


def stamp_of(index: int, fps: float) -> int:
    """Return the stamp in ns of the picture `index` (from 0) at `fps` pictures per second.

    Raises
    ------
    InputError
        If it is later than ROS can express.
    """
    if index * 1e9 / fps > LAST_STAMP_NS - START_NS:
        raise InputError(
            f"image {index} at {fps:g} frames per second is later than the last time that ROS can "
            "express, 2^31 s"
        )
    return START_NS + round(index * 1e9 / fps)


_REQUIRED = ("frame", "x", "y", "w", "h")


@dataclass(frozen=True, slots=True)
class TruthRow:
    """True box (px) of the vehicle in a frame, and its occlusion."""

    box: Box
    occlusion: Occlusion


def read_truth_table(path: Path) -> dict[int, TruthRow]:
    """Read the truth by the number of the frame.

    The columns are ``frame,x,y,w,h`` (top-left corner and size in px) and optionally ``visible``
    (0: not at all) and ``occ`` (0 none, 1 partial, 2 total). A row with an empty cell, NaN or no
    area says that the frame has no truth.

    Raises
    ------
    InputError
        If the table cannot be read, lacks a column, holds no box, names a frame twice, or has a
        cell that is not a number.
    """
    if path.exists() and not path.is_file():
        raise InputError(f"the truth {path} is not a regular file")
    try:
        with path.open(newline="", encoding="utf-8-sig") as stream:
            return _rows(path, csv.DictReader(stream))
    except OSError as error:
        raise InputError(f"cannot read the truth {path}: {error.strerror}") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"the truth {path} is not a text table: {error}") from error


def _rows(path: Path, reader: csv.DictReader[str]) -> dict[int, TruthRow]:
    columns = [name.strip() for name in reader.fieldnames or ()]
    if not columns:
        raise InputError(f"the truth {path} is empty")
    lacking = [name for name in _REQUIRED if name not in columns]
    if lacking:
        raise InputError(
            f"the truth {path} lacks the column {lacking[0]}; its first line names them"
        )
    reader.fieldnames = columns
    table: dict[int, TruthRow] = {}
    seen: set[int] = set()
    for cells in reader:
        location = f"line {reader.line_num} of the truth {path}"
        number, row = _row(location, cells)
        if number in seen:
            raise InputError(f"{location} names frame {number} a second time")
        seen.add(number)
        if row is not None:
            table[number] = row
    if not table:
        raise InputError(f"the truth {path} holds no box")
    return table


def _row(location: str, cells: dict[str, str]) -> tuple[int, TruthRow | None]:
    frame, x, y, width, height = (_number(location, name, cells.get(name)) for name in _REQUIRED)
    if not frame.is_integer():
        raise InputError(f"{location} has no integer as its frame")
    values = (x, y, width, height)
    if any(abs(value) > LARGEST_PX for value in values if math.isfinite(value)):
        raise InputError(f"{location} has a box beyond {LARGEST_PX:.0f} px")
    if not all(map(math.isfinite, values)) or width <= 0 or height <= 0:
        return int(frame), None
    return int(frame), TruthRow(Box(*values), _occlusion(location, cells))


def _occlusion(location: str, cells: dict[str, str]) -> Occlusion:
    if _number(location, "visible", cells.get("visible")) == 0:
        return Occlusion.TOTAL
    occlusion = _number(location, "occ", cells.get("occ"))
    if math.isnan(occlusion):
        return Occlusion.NONE
    if occlusion not in set(Occlusion):
        raise InputError(f"{location} has occ {occlusion:g}; it must be 0, 1 or 2")
    return Occlusion(int(occlusion))


def _number(location: str, name: str, cell: str | None) -> float:
    """Read a cell; an empty or missing one is NaN."""
    if cell is None or not cell.strip():
        return math.nan
    try:
        return float(cell)
    except ValueError:
        raise InputError(f"{location} has {cell!r} as {name}, which is not a number") from None
