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

"""Folders in the layout of MOTChallenge: images, detections and the true boxes of every vehicle."""

from __future__ import annotations

import configparser
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame

TOTAL_OCCLUSION = 0.1
"""Visible share below which a vehicle counts as totally hidden, where no flags say so."""

EVERY_FRAME = 0
"""Frame number of a region to ignore in all frames."""

_INFO = ("seqLength", "frameRate", "imWidth", "imHeight")
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


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
        folder = self.folder / "img1"
        for number in range(1, self.frame_count + 1):
            path = next(iter(sorted(folder.glob(f"{number:06d}.*"))), None)
            image = cv2.imread(str(path)) if path else None
            if image is None:
                raise InputError(f"{folder} has no readable image {number:06d}")
            yield np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB), dtype=np.uint8)


def read_sequence(folder: Path) -> TrafficSequence:
    """Read a folder with ``seqinfo.ini``, ``img1``, ``gt/gt.txt`` and perhaps ``det/*.txt``.

    ``gt/flags.csv`` (frame, id, occ) says which boxes are totally hidden; without it, a visibility
    below `TOTAL_OCCLUSION` does. ``ignore.txt`` lists regions without truth.

    Raises
    ------
    InputError
        If a file is missing or cannot be read.
    """
    info = _read_info(folder / "seqinfo.ini")
    truth = read_table(folder / "gt" / "gt.txt", 6)
    detections = {
        path.stem: read_table(path, 7)[:, [0, 2, 3, 4, 5, 6]]
        for path in sorted((folder / "det").glob("*.txt"))
    }
    ignored = folder / "ignore.txt"
    return TrafficSequence(
        folder=folder,
        frame_count=int(info["seqLength"]),
        frame_rate=info["frameRate"],
        size=(int(info["imWidth"]), int(info["imHeight"])),
        truth=truth[:, :6],
        hidden=_hidden(folder, truth),
        ignored=read_table(ignored, 5)[:, :5] if ignored.is_file() else np.empty((0, 5)),
        detections=detections,
    )


def _read_info(path: Path) -> dict[str, float]:
    parser = configparser.ConfigParser()
    if not path.is_file():
        raise InputError(f"{path.parent} is not a MOTChallenge folder: it has no {path.name}")
    parser.read(path, encoding="utf-8")
    info = {}
    for key in _INFO:
        text = parser.get("Sequence", key, fallback="")
        if not _NUMBER.fullmatch(text):
            fault = f"gives a {key} that is not a number: {text}" if text else f"gives no {key}"
            raise InputError(f"{path} {fault}")
        info[key] = float(text)
    return info


def read_table(path: Path, columns: int) -> Array:
    """Read lines of comma-separated numbers of at least `columns` each; text behind them is left.

    Raises
    ------
    InputError
        If there is no such file, or a line has too few numbers.
    """
    if not path.is_file():
        raise InputError(f"there is no file {path}")
    lines = enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
    rows = [
        _numbers(line, columns, f"{path}, line {number}")
        for number, line in lines
        if line.strip() and not line.startswith("#")
    ]
    width = min(map(len, rows), default=columns)
    return np.array([row[:width] for row in rows], dtype=np.float64).reshape(-1, width)


def _numbers(line: str, columns: int, where: str) -> list[float]:
    numbers = list(map(float, takewhile(_NUMBER.fullmatch, map(str.strip, line.split(",")))))
    if len(numbers) < columns or not all(map(math.isfinite, numbers[:columns])):
        raise InputError(f"{where} does not begin with {columns} finite numbers: {line[:60]}")
    return numbers


def _hidden(folder: Path, truth: Array) -> npt.NDArray[np.bool_]:
    flags = folder / "gt" / "flags.csv"
    if not flags.is_file():
        visible = truth[:, 8] if truth.shape[1] > 8 else np.ones(len(truth))
        return np.asarray(visible < TOTAL_OCCLUSION)
    lines = flags.read_text(encoding="utf-8").splitlines()[1:]
    rows = (map(int, line.split(",")[:3]) for line in lines)
    total = {(frame, identity) for frame, identity, occlusion in rows if occlusion == 2}
    keys = truth[:, :2].astype(int).tolist()
    return np.array([tuple(key) in total for key in keys], dtype=np.bool_)
