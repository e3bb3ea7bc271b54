# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Footage in a folder of images: their numbers, their frame rate, and truth if there is any."""

from __future__ import annotations

import configparser
import json
import math
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.image.compressed_image import decode_compressed
from vehicle_pf_tracker.recordings.footage import (
    Footage,
    Picture,
    StampedFrame,
    check_fps,
    stamp_of,
)
from vehicle_pf_tracker.recordings.truth_files import read_truth, truth_beside
from vehicle_pf_tracker.recordings.truth_formats import Images

FORMATS = {".jpg": "jpeg", ".jpeg": "jpeg", ".png": "png"}
"""The image files that are read, and what a CompressedImage calls them."""


IMAGE_FOLDERS = ("img", "img1", "color", "images", ".")
"""Places of the images in a folder, the first that has any: OTB's and ours, MOTChallenge's, VOT's,
CVAT's."""

ASSUMED_FPS = 30.0
"""Frame rate of a folder that states none, 1/s; the commonest of video cameras."""


class FrameFolder(Footage):
    """A folder of numbered images with their frame rate, and with truth if there is any.

    Images are numbered by the digits that end their names, or by their order where a name has none.
    A gap in the numbers is a gap in the stamps. Truth belongs to the image of its number. The frame
    rate is the one given, else that of ``sequence.json`` or ``seqinfo.ini``, else `ASSUMED_FPS`,
    which `notices` reports.

    Parameters
    ----------
    folder : Path
        The folder; images are in one of `IMAGE_FOLDERS` below it.
    fps : float or None
        Frame rate, 1/s; None to look for it.
    truth : Path or None
        File of the truth; None to look for it, as `truth_beside` does.
    identity : int or None
        Number of the target, where the truth has several.

    Attributes
    ----------
    images : mapping of int to Path
        The image files by their numbers, in order.
    stamps : list of int
        Their stamps in ns; the first is at the start, whatever its number.
    truths : mapping of int to Truth
        The truth by the number of its image; empty where there is none.

    Raises
    ------
    InputError
        If there are no images, two have one number, the frame rate is invalid, or the truth is
        faulty or belongs to none of the images.
    """

    def __init__(
        self,
        folder: Path,
        fps: float | None = None,
        truth: Path | None = None,
        identity: int | None = None,
    ) -> None:
        self.images = numbered_images(folder)
        self.frame_count = len(self.images)
        stated = _frame_rate(folder) if fps is None else check_fps(fps, "--fps")
        self.fps = ASSUMED_FPS if stated is None else stated
        first = min(self.images)
        self.stamps = [stamp_of(number - first, self.fps) for number in self.images]
        names = {path.name: number for number, path in self.images.items()}
        images = Images(list(self.images), self._size, names)
        if truth is None:
            beside = folder.parent if folder.name in IMAGE_FOLDERS else folder
            table, notices = truth_beside(beside, images, identity)
        else:
            table, notices = read_truth([truth], images, identity)
        numbered = zip(self.images, self.stamps, strict=True)
        self.truths = {n: replace(table[n], stamp_ns=at) for n, at in numbered if n in table}
        if table and not self.truths:
            raise InputError(f"no frame of the truth {truth or 'in ' + str(folder)} has an image")
        if stated is None:
            notices.append(
                f"the folder {folder} states no frame rate; {ASSUMED_FPS:g} frames/s are assumed, "
                "give --fps or a sequence.json to change that"
            )
        if lost := len(table) - len(self.truths):
            notices.append(f"frames of the truth without an image: {lost}")
        self._notices = self._found = notices

    def frames(self) -> Iterator[StampedFrame]:
        """Yield the images by their numbers; one that cannot be read has its stamp but no frame.

        Raises
        ------
        InputError
            If none can be read.
        """
        unread: list[str] = []
        for (number, path), stamp in zip(self.images.items(), self.stamps, strict=True):
            try:
                picture: StampedFrame = read_picture(path, stamp, self.truths.get(number))
            except InputError as error:
                picture = StampedFrame(stamp, None)
                unread.append(str(error))
                said = f"images that cannot be read: {len(unread)}; {unread[0]}"
                self._notices = [*self._found, said]
            yield picture
        if len(unread) == self.frame_count:
            raise InputError(unread[0])

    def truth(self) -> list[Truth]:
        """Return the truth of all images, in order."""
        return list(self.truths.values())

    def _size(self) -> tuple[int, int]:
        return frame_size(read_picture(next(iter(self.images.values()))).frame)


def image_files(folder: Path) -> list[Path]:
    """Return the images in a folder or in one of `IMAGE_FOLDERS` below it, by name."""
    for name in IMAGE_FOLDERS:
        paths = sorted(p for p in (folder / name).glob("*") if p.suffix.lower() in FORMATS)
        if paths:
            return paths
    return []


def numbered_images(folder: Path) -> dict[int, Path]:
    """Return images by number: their name, else its last digits, else their order.

    Raises
    ------
    InputError
        If there are none, or two have one number.
    """
    paths = image_files(folder)
    if not paths:
        raise InputError(f"the folder {folder} has no images img/000001.jpg, ... (jpg or png)")
    for path in paths:
        if not path.is_file():
            raise InputError(f"the image {path} is not a regular file")
    numbered = [path for path in paths if path.stem.isdecimal()] or paths
    endings = [re.search(r"\d+$", path.stem) for path in numbered]
    numbers = [int(end[0]) for end in endings if end]
    if not all(endings):
        numbers = list(range(1, len(numbered) + 1))
    images: dict[int, Path] = {}
    for number, path in zip(numbers, numbered, strict=True):
        if number in images:
            raise InputError(f"{path} and {images[number].name} have the same number")
        images[number] = path
    return dict(sorted(images.items()))


def _frame_rate(folder: Path) -> float | None:
    """Return the frame rate that a file in the folder states, 1/s; None without such a file."""
    for name, read in (("sequence.json", _of_json), ("seqinfo.ini", _of_ini)):
        path = folder / name
        if not path.exists():
            continue
        text = read_text(path, "the file")
        try:
            fps = read(text)
        except (ValueError, KeyError, TypeError, RecursionError, configparser.Error):
            raise InputError(
                f"{path} does not state the frame rate; it must hold {_EXAMPLES[name]}"
            ) from None
        return check_fps(fps, path)
    return None


_EXAMPLES = {"sequence.json": '{"fps": 30}', "seqinfo.ini": "[Sequence] frameRate=30"}


def _of_json(text: str) -> float:
    fps = json.loads(text)["fps"]
    is_number = isinstance(fps, int | float) and not isinstance(fps, bool)
    return fps if is_number else math.nan


def _of_ini(text: str) -> float:
    parser = configparser.ConfigParser(interpolation=None)
    parser.read_string(text)
    return float(parser["Sequence"]["frameRate"])


def read_picture(path: Path, stamp_ns: int = 0, truth: Truth | None = None) -> Picture:
    """Read an image, which has this stamp and truth.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    coded_format = FORMATS[path.suffix.lower()]
    try:
        coded = path.read_bytes()
        frame = decode_compressed(coded_format, coded)
    except OSError as error:
        raise InputError(f"cannot read the image {path}: {error.strerror}") from error
    except InputError as error:
        raise InputError(f"the image {path} cannot be read: {error}") from error
    return Picture(stamp_ns, frame, str(path), coded_format, coded, truth)
