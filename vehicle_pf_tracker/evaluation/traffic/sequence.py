# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Folders in the layout of MOTChallenge: images, detections and the true boxes of every vehicle."""

from __future__ import annotations

import configparser
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import TOTAL_BELOW
from vehicle_pf_tracker.recordings.frame_folder import numbered_images, read_picture
from vehicle_pf_tracker.recordings.text_tables import numbers_in, table_rows

EVERY_FRAME = 0
"""Frame number of a region to ignore in all frames."""


@dataclass(frozen=True, slots=True)
class TrafficSequence:
    """A scene with many vehicles, its truth and detections.

    Attributes
    ----------
    folder : Path
        Where it was read from.
    frame_count, frame_rate : int, float
        Number of frames, and frames per second.
    size : (int, int)
        Width and height of an image, px.
    truth : array, shape (N, 6)
        Frame from 1, identity, left, top, width and height in px of each true box.
    hidden : array of bool, shape (N,)
        True where the box is totally hidden.
    ignored : array, shape (M, 5)
        Regions without truth: frame or `EVERY_FRAME`, left, top, width, height.
    detections : dict of str to array, shape (K, 6)
        By the detector's name: frame, left, top, width, height, score.
    """

    folder: Path
    frame_count: int
    frame_rate: float
    size: tuple[int, int]
    truth: Array
    hidden: npt.NDArray[np.bool_]
    ignored: Array
    detections: dict[str, Array]

    @property
    def name(self) -> str:
        """Name of its folder."""
        return self.folder.name

    def frames(self) -> Iterator[Frame]:
        """Read the images, in order."""
        images = numbered_images(self.folder, self.frame_rate)
        for number in range(1, self.frame_count + 1):
            if number not in images:
                raise InputError(f"{self.folder} has no image {number}")
            yield read_picture(images[number]).frame


def read_sequence(folder: Path) -> TrafficSequence:
    """Read a folder with ``seqinfo.ini``, ``img1``, ``gt/gt.txt`` and perhaps ``det/*.txt``.

    ``gt/flags.csv`` (frame, id, occ) says which boxes are totally hidden; without it, a visibility
    below `TOTAL_BELOW` does. ``ignore.txt`` lists regions without truth.

    Raises
    ------
    InputError
        If a file is missing or cannot be read.
    """
    info = folder / "seqinfo.ini"
    if not info.is_file():
        raise InputError(f"{folder} is not a MOTChallenge folder: it has no {info.name}")
    # Without interpolation: a % in a name is a letter.
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(read_text(info, "the file"))
        frame_rate = parser.getfloat("Sequence", "frameRate")
        names = "seqLength", "imWidth", "imHeight"
        frame_count, width, height = (parser.getint("Sequence", name) for name in names)
    except (configparser.Error, ValueError) as error:
        raise InputError(f"{info} does not describe a sequence: {error}") from None
    if not (0 < frame_rate < math.inf and min(frame_count, width, height) > 0):
        raise InputError(f"{info} does not describe a sequence: its numbers must be above 0")
    truth = read_table(folder / "gt" / "gt.txt", 6, 9)
    detections = {
        path.stem: read_table(path, 7)[:, [0, 2, 3, 4, 5, 6]]
        for path in sorted((folder / "det").glob("*.txt"))
    }
    ignored = folder / "ignore.txt"
    return TrafficSequence(
        folder=folder,
        frame_count=frame_count,
        frame_rate=frame_rate,
        size=(width, height),
        truth=truth[:, :6],
        hidden=_hidden(folder, truth),
        ignored=read_table(ignored, 5) if ignored.is_file() else np.empty((0, 5)),
        detections=detections,
    )


def read_table(path: Path, least: int, most: int = 0) -> Array:
    """Read lines of `least` numbers, or up to `most` where all have them; the rest is passed over.

    Raises
    ------
    InputError
        If there is no such file, or a line has too few numbers.
    """
    lines = table_rows(path, read_text(path, "the table"), least, "the table")
    rows = []
    for where, cells in lines:
        rows.append(numbers_in(where, cells[: max(least, most)]))
        if not all(map(math.isfinite, rows[-1])):
            raise InputError(f"{where} has a number that is not finite, or an empty cell")
    # Rows of several lengths, as after an edit by hand, are cut to what all have.
    width = min(map(len, rows), default=least)
    return np.array([row[:width] for row in rows], dtype=np.float64).reshape(-1, width)


def _hidden(folder: Path, truth: Array) -> npt.NDArray[np.bool_]:
    flags = folder / "gt" / "flags.csv"
    if not flags.is_file():
        # A table without visibilities says nothing of occlusions: nothing is hidden.
        visible = truth[:, 8] if truth.shape[1] > 8 else np.ones(len(truth))
        return np.asarray(visible < TOTAL_BELOW)
    lines = flags.read_text(encoding="utf-8").splitlines()[1:]
    rows = (map(int, line.split(",")[:3]) for line in lines)
    # 2 is a total occlusion in the flags; boxes are found by frame and number, whatever their
    # order.
    total = {(frame, identity) for frame, identity, occlusion in rows if occlusion == 2}
    keys = truth[:, :2].astype(int).tolist()
    return np.array([tuple(key) in total for key in keys], dtype=np.bool_)
