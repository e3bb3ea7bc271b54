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

"""Footage in a frame folder: `img/000001.jpg`..., `sequence.json`, `groundtruth.csv`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.image.compressed_image import decode_compressed
from vehicle_pf_tracker.recordings.footage import (
    Picture,
    TruthRow,
    check_fps,
    read_truth_table,
    stamp_of,
)

FORMATS = {".jpg": "jpeg", ".jpeg": "jpeg", ".png": "png"}
"""The image files that are read, and what a CompressedImage calls them."""


class FrameFolder:
    """A folder of numbered images with their frame rate, and with truth if there is any.

    A gap in the numbers is a gap in the stamps. Truth belongs to the image of its number.

    Attributes
    ----------
    images : mapping of int to Path
        The image files by their numbers, in order.
    truth : mapping of int to TruthRow
        The truth by the number of its image; empty where there is none.
    total : int
        Number of images.
    fps : float
        Frames per second.

    Raises
    ------
    InputError
        If there are no images, two have one number, the frame rate is missing, or the truth is
        faulty or belongs to none of the images.
    """

    def __init__(self, folder: Path) -> None:
        self.images = _numbered_images(folder)
        self.total: int | None = len(self.images)
        self.fps = _frame_rate(folder / "sequence.json")
        stamp_of(max(self.images) - min(self.images), self.fps)  # refuses what ROS cannot express
        truth_path = folder / "groundtruth.csv"
        self.truth = read_truth_table(truth_path) if truth_path.exists() else {}
        if self.truth and not self.truth.keys() & self.images.keys():
            raise InputError(f"no frame of the truth {truth_path} has an image")

    def pictures(self) -> Iterator[Picture]:
        """Yield the images by their numbers; the first is at the start, whatever its number."""
        first = min(self.images)
        for number, path in self.images.items():
            stamp = stamp_of(number - first, self.fps)
            yield _picture(path, stamp, self.truth.get(number))

    def notices(self) -> list[str]:
        """Report truth without an image."""
        lost = len(self.truth.keys() - self.images.keys())
        return [f"frames of the truth without an image: {lost}"] if lost else []


def _numbered_images(folder: Path) -> dict[int, Path]:
    images: dict[int, Path] = {}
    for path in sorted((folder / "img").glob("*")):
        if path.suffix.lower() not in FORMATS or not path.stem.isdecimal():
            continue
        if not path.is_file():
            raise InputError(f"the image {path} is not a regular file")
        number = int(path.stem)
        if number in images:
            raise InputError(f"{path} and {images[number].name} have the same number")
        images[number] = path
    if not images:
        raise InputError(f"the folder {folder} has no images img/000001.jpg, ... (jpg or png)")
    return dict(sorted(images.items()))


def _frame_rate(path: Path) -> float:
    if path.exists() and not path.is_file():
        raise InputError(f"{path} is not a regular file")
    try:
        fps = json.loads(path.read_text(encoding="utf-8"))["fps"]
    except OSError as error:
        raise InputError(
            f"cannot read {path}: {error.strerror}; the frame rate is needed, "
            'a file with {"fps": 30} will do'
        ) from error
    except (ValueError, KeyError, TypeError, RecursionError):
        raise InputError(
            f'{path} does not state the frame rate; it must hold {{"fps": 30}}'
        ) from None
    is_number = isinstance(fps, int | float) and not isinstance(fps, bool)
    return check_fps(fps if is_number else math.nan, path)


def _picture(path: Path, stamp_ns: int, row: TruthRow | None) -> Picture:
    coded_format = FORMATS[path.suffix.lower()]
    try:
        coded = path.read_bytes()
        frame = decode_compressed(coded_format, coded)
    except OSError as error:
        raise InputError(f"cannot read the image {path}: {error.strerror}") from error
    except InputError as error:
        raise InputError(f"the image {path} cannot be read: {error}") from error
    truth = None if row is None else Truth(stamp_ns, row.box, row.occlusion)
    return Picture(stamp_ns, frame, str(path), coded_format, coded, truth)
