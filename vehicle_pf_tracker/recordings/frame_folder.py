# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Footage in a folder of images."""

from __future__ import annotations

import configparser
import json
import math
import statistics
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.image.formats.compressed_image import decode_compressed
from vehicle_pf_tracker.recordings.footage import (
    LAST_STAMP_NS,
    START_NS,
    Footage,
    Picture,
    StampedFrame,
    check_fps,
    stamp_of,
)
from vehicle_pf_tracker.recordings.image_names import NamedImages, natural_key, number_images
from vehicle_pf_tracker.recordings.truth.files import Beside, read_truth, truth_beside
from vehicle_pf_tracker.recordings.truth.labels import Images

IMAGE_FORMATS = {".jpg": "jpeg", ".jpeg": "jpeg", ".png": "png"}
"""The image files that are read, and what a CompressedImage calls them."""

_OTHERS = {".bmp", ".tif", ".tiff", ".ppm", ".pgm", ".webp", ".gif", ".jp2"}
"""Endings of images that are not read: a CompressedImage has no name for most of them."""

IMAGE_FOLDERS = ("img", "img1", "color", "images", ".")
"""Places of the images in a folder, the first that has any: OTB's and ours, MOTChallenge's, VOT's,
CVAT's."""

ASSUMED_FPS = 30.0
"""Frame rate of a folder that states none, 1/s; the commonest of video cameras."""


class FrameFolder(Footage):
    """A folder of images with their times, and with truth if there is any.

    Images are in the natural order of their names (`number_images`). Names that are times give the
    stamps, unless a frame rate is given. Elsewhere the frame rate is the one given, else that of
    ``sequence.json`` or ``seqinfo.ini``, else `ASSUMED_FPS`, which `notices` reports, and a gap in
    the numbers is a gap in the stamps. Truth belongs to the image of its number.

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
    beside : Beside
        Use of the truth beside the images.

    Attributes
    ----------
    images : mapping of int to Path
        The image files by their numbers, in order.
    stamps : list of int
        Stamps of the images, ns. Unless they are times since 1970, the first is at the start.
    truths : mapping of int to Truth
        The truth by the number of its image; empty where there is none.

    Raises
    ------
    InputError
        If there are no images, two have one number, the names leave the times open, the frame rate
        is invalid, or the truth is faulty or belongs to none of the images.
    """

    def __init__(
        self,
        folder: Path,
        fps: float | None = None,
        truth: Path | None = None,
        identity: int | None = None,
        beside: Beside = Beside.NEEDED,
    ) -> None:
        stated = _frame_rate(folder) if fps is None else check_fps(fps, "--fps")
        # A rate that the user gives takes the place of times in the names.
        named = number_images(_listed(folder), stated, is_given=fps is not None)
        self.images = named.images
        self.frame_count = len(self.images)
        self.stamps, self.fps = _stamps(named, stated)
        notices = named.notices
        # Times in the names are a frame rate, too.
        if stated is None and named.times_ns is None:
            notices.append(
                f"the folder {folder} states no frame rate; {ASSUMED_FPS:g} frames/s are assumed, "
                "give --fps or a sequence.json to change that"
            )
        # By name without the folder: truth files name images that way.
        names = {path.name: number for number, path in self.images.items()}
        images = Images(list(self.images), self._size, names)
        if truth is None:
            # OTB and others have the images in img/ and the truth beside that folder.
            home = folder.parent if folder.name in IMAGE_FOLDERS else folder
            table, said = truth_beside(home, images, identity, beside)
        else:
            table, said = read_truth([truth], images, identity)
        notices += said
        numbered = zip(self.images, self.stamps, strict=True)
        self.truths = {n: replace(table[n], stamp_ns=at) for n, at in numbered if n in table}
        # Rows of dropped images are no error: the rest of the truth is still right.
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
                # A new list: whoever took the one before keeps it as it was.
                self._notices = [*self._found, said]
            yield picture
        # Only here: one that can be read, however late, makes the folder usable.
        if len(unread) == self.frame_count:
            raise InputError(unread[0])

    def truth(self) -> list[Truth]:
        """Return the truth of all images, in order."""
        return list(self.truths.values())

    def _size(self) -> tuple[int, int]:
        return frame_size(read_picture(next(iter(self.images.values()))).frame)


def image_files(folder: Path) -> list[Path]:
    """Return the images in a folder or in one of `IMAGE_FOLDERS` below it, in natural order.

    Names that begin with a dot are no images: macOS keeps attributes of ``a.jpg`` in ``._a.jpg``.
    """
    for name in IMAGE_FOLDERS:
        paths = [
            path for path in (folder / name).glob("[!.]*") if path.suffix.lower() in IMAGE_FORMATS
        ]
        if paths:
            return sorted(paths, key=lambda path: (natural_key(path.stem), path.name))
    return []


def numbered_images(folder: Path, fps: float) -> dict[int, Path]:
    """Return the images of a folder by number, at a frame rate in 1/s.

    Raises
    ------
    InputError
        If there are none, or two have one number.
    """
    return number_images(_listed(folder), fps).images


def _listed(folder: Path) -> list[Path]:
    paths = image_files(folder)
    if not paths:
        raise InputError(
            f"the folder {folder} has no images img/000001.jpg, ... (jpg or png){_others(folder)}"
        )
    for path in paths:
        if not path.is_file():
            raise InputError(f"the image {path} is not a regular file")
    return paths


def _others(folder: Path) -> str:
    """Return that a folder has images of other formats, to be put behind a sentence."""
    for name in IMAGE_FOLDERS:
        paths = [path for path in (folder / name).glob("[!.]*") if path.suffix.lower() in _OTHERS]
        if paths:
            return f"; convert its {len(paths)} images as {paths[0].name} to png"
    return ""


def _stamps(named: NamedImages, stated: float | None) -> tuple[list[int], float]:
    """Return the stamps of images in ns, and their frame rate in 1/s."""
    times = named.times_ns
    if times is None:
        fps = stated or ASSUMED_FPS
        # Numbered from the smallest, which need not be 0 or 1; gaps stay gaps.
        first = min(named.images)
        return [stamp_of(number - first, fps) for number in named.images], fps
    # Times from an unknown start are moved to ours; those since 1970 mean something.
    origin = 0 if named.since_1970 else START_NS - times[0]
    if times[-1] + origin > LAST_STAMP_NS:
        # Named by times, images count from 1: the last is number len(times).
        raise InputError(f"{named.images[len(times)]} is later than the last time of ROS, 2^31 s")
    steps = [after - before for before, after in pairwise(times)]
    # The median: dropped images lengthen some steps, and must not slow all down.
    fps = 1e9 / statistics.median(steps) if steps else stated or ASSUMED_FPS
    return [time + origin for time in times], fps


def _frame_rate(folder: Path) -> float | None:
    """Return the frame rate that a file in the folder states, 1/s; None without such a file."""
    # Ours first: it takes the place of another that lies beside it.
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
    # True is an int in Python, and no frame rate.
    is_number = isinstance(fps, int | float) and not isinstance(fps, bool)
    return fps if is_number else math.nan


def _of_ini(text: str) -> float:
    # Without interpolation a % in another line is text, and no error.
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
    coded_format = IMAGE_FORMATS[path.suffix.lower()]
    try:
        coded = path.read_bytes()
        frame = decode_compressed(coded_format, coded)
    except OSError as error:
        raise InputError(f"cannot read the image {path}: {error.strerror}") from error
    except InputError as error:
        raise InputError(f"the image {path} cannot be read: {error}") from error
    return Picture(stamp_ns, frame, str(path), coded_format, coded, truth)
