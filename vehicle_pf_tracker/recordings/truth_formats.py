# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The formats of truth: those of data sets, of annotation tools, and our own table.

Each reader yields the boxes that a file states, in our coordinates: the first pixel begins at 0.
`FORMATS` says by the first line of a file which one reads it.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise, zip_longest
from pathlib import Path
from typing import Any, TypeAlias
from xml.etree import ElementTree

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.truth import Occlusion

Sides: TypeAlias = tuple[float, float, float, float]
ABSENT: Sides = (math.nan, math.nan, math.nan, math.nan)
_GAP = r"\s*[,;\s]\s*"
_SHOWN = 60
"""Letters of a bad cell that an error shows."""


class UnreadTruthError(InputError):
    """Raised for a file that looks like truth, but has no known format or several targets."""


@dataclass(frozen=True, slots=True)
class Images:
    """The images that truth belongs to.

    Attributes
    ----------
    numbers : sequence of int
        Their numbers, in order.
    size : callable
        Reads the width and height in px.
    names : mapping of str to int
        The number of each image file; empty for a video.
    """

    numbers: Sequence[int]
    size: Callable[[], tuple[int, int]]
    names: Mapping[str, int]

    def nth(self, index: int) -> int:
        """Return the number of an image by its index from 0, also of one that is not there."""
        last = len(self.numbers) - 1
        near = min(max(index, 0), last)
        return self.numbers[near] + index - near


@dataclass(frozen=True, slots=True)
class Label:
    """Truth of a target in one image, as its file states it.

    Attributes
    ----------
    where : str
        Place in the file, for an error.
    number : float
        Number of the image.
    sides : tuple of float
        Left, top, width and height in px; NaN or no area where the target is absent.
    occlusion : Occlusion
        Degree of occlusion.
    identity : float
        Number of the target; 1 where the file has but one.
    """

    where: str
    number: float
    sides: Sides
    occlusion: Occlusion = Occlusion.NONE
    identity: float = 1


def _number(where: str, name: str, cell: str | None) -> float:
    """Read a cell; an empty or missing one is NaN."""
    if cell is None or not cell.strip():
        return math.nan
    try:
        return float(cell)
    except ValueError:
        raise InputError(
            f"{where} has {cell[:_SHOWN]!r} as {name}, which is not a number"
        ) from None


def table_rows(
    path: Path, text: str, least: int, what: str = "the truth"
) -> Iterator[tuple[str, list[str]]]:
    """Yield the place and the cells, at least so many, of each line but comments and empty ones.

    Cells are apart by commas, semicolons or spaces; a comment begins with ``#``.
    """
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.strip(" \t,;")
        if words and not words.startswith("#"):
            cells, where = re.split(_GAP, words), f"line {number} of {what} {path}"
            if len(cells) < least:
                raise InputError(f"{where} has {len(cells)} cells, of at least {least}")
            yield where, cells


def numbers_in(where: str, cells: Sequence[str]) -> list[float]:
    """Read cells; an empty one is NaN."""
    return [_number(where, f"number {place}", cell) for place, cell in enumerate(cells, start=1)]


def _list(path: Path) -> list[float]:
    """Read a file of numbers alone."""
    cells = re.split(_GAP, read_text(path, "the truth").strip(", \t\r\n"))
    return numbers_in(f"the truth {path}", cells)


_REQUIRED = ("frame", "x", "y", "w", "h")


def _own(path: Path, text: str, _: Images) -> Iterator[Label]:
    """Read our table: frame,x,y,w,h, and perhaps visible (0: not at all) and occ (0, 1 or 2)."""
    reader = csv.DictReader(io.StringIO(text, newline=""))
    try:
        reader.fieldnames = [name.strip() for name in reader.fieldnames or ()]
        if lacking := [name for name in _REQUIRED if name not in reader.fieldnames]:
            raise InputError(
                f"the truth {path} lacks the column {lacking[0]}; its first line names them"
            )
        for cells in reader:
            where = f"line {reader.line_num} of the truth {path}"
            number, x, y, w, h = (_number(where, name, cells.get(name)) for name in _REQUIRED)
            occlusion = _number(where, "occ", cells.get("occ"))
            if _number(where, "visible", cells.get("visible")) == 0:
                occlusion = Occlusion.TOTAL
            if not math.isnan(occlusion) and occlusion not in set(Occlusion):
                raise InputError(f"{where} has occ {occlusion:g}; it must be 0, 1 or 2")
            state = Occlusion.NONE if math.isnan(occlusion) else Occlusion(int(occlusion))
            yield Label(where, number, (x, y, w, h), state)
    except csv.Error as error:
        raise InputError(f"the truth {path} is not a text table: {error}") from error


_PRESENCE: Mapping[float, Occlusion | None] = {1.0: None}
_FLAGS: Mapping[str, Mapping[float, Occlusion | None]] = {
    "out_of_view.txt": _PRESENCE,
    "absence.label": _PRESENCE,
    "full_occlusion.txt": {1.0: Occlusion.TOTAL},
    "cover.label": {float(level): Occlusion.of(level / 8) for level in range(9)},
    "occlusion.tag": {1.0: Occlusion.PARTIAL},
    "occlusion.label": {1.0: Occlusion.PARTIAL},
}
"""Files with a flag per image, and what each means; None: absent. LaSOT's two, GOT-10k's (cover:
visible eighths), and VOT's."""


def _flags(folder: Path) -> list[Occlusion | None]:
    """Return the state of the target in each image by the files of `_FLAGS`."""
    columns = []
    for path, meaning in ((folder / name, meaning) for name, meaning in _FLAGS.items()):
        if path.is_file():
            columns.append([meaning.get(flag, Occlusion.NONE) for flag in _list(path)])
    states = (set(row) for row in zip_longest(*columns, fillvalue=Occlusion.NONE))
    return [None if None in state else max(state - {None}) for state in states]  # type: ignore[type-var]


def in_order(path: Path, text: str, images: Images) -> Iterator[Label]:
    """Read a box or a polygon per image: OTB, TC128, UAV123, LaSOT, GOT-10k, UAVDT-S and VOT.

    Boxes count pixels from 1: the toolkits of OTB, TC128, UAV123 and UAVDT are MATLAB's; for LaSOT
    see issue 14 of its toolkit, for GOT-10k issue 6. VOT's boxes (beside its file ``sequence``) and
    polygons stay as they are, as in its toolkit; of a polygon the upright hull is taken.
    TC128's ``NAME_frames.txt`` has the numbers of the first and the last image.
    """
    folder, begin = path.parent, 0
    first_px = 0 if (folder / "sequence").is_file() or any(folder.glob("*.tag")) else 1
    span = folder / path.name.replace("_gt.", "_frames.")
    if span != path and span.is_file():
        first = _list(span)[0]
        begin = images.numbers.index(int(first)) if first in images.numbers else 0
    ending = re.search(r"^groundtruth.*[._](\d+)$", path.stem)
    flags = _flags(folder)
    for index, (where, cells) in enumerate(table_rows(path, text, 1)):
        values = numbers_in(where, cells)
        state = flags[index] if index < len(flags) else Occlusion.NONE
        if len(values) not in (1, 4, 8):
            raise InputError(f"{where} has {len(values)} numbers; a box has 4, a polygon 8")
        if state is None or len(values) == 1:  # a single number is VOT's code for no box
            sides = ABSENT
        elif len(values) == 4:
            sides = (values[0] - first_px, values[1] - first_px, values[2], values[3])
        else:
            xs, ys = values[::2], values[1::2]
            sides = (min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys))
        identity = int(ending.group(1)) if ending else 1
        yield Label(where, images.nth(begin + index), sides, state or Occlusion.NONE, identity)


def _mot(path: Path, text: str, _: Images) -> Iterator[Label]:
    """Read MOTChallenge's rows, frame,id,left,top,width,height,conf,class,visibility, and UAVDT's.

    Frames and pixels count from 1 (motchallenge.net/instructions), but pixels from 0 in what CVAT
    and our `synth` write, with ``labels.txt`` or ``occluders.csv`` beside. UAVDT's ``gt_whole``
    ends in out of view, occlusion (1 none, 2 large to 4 small) and class.
    """
    others = [path.with_name(name) for name in ("labels.txt", "occluders.csv")]
    first_px = 0 if any(one.is_file() for one in others) else 1
    is_uavdt = path.stem.endswith("_gt_whole")
    for where, cells in table_rows(path, text, 6):
        number, identity, x, y, w, h, *rest = numbers_in(where, cells)
        visible = rest[2] if len(rest) > 2 else 1.0
        if is_uavdt:
            occlusion = Occlusion.PARTIAL if rest[1:2] > [1.0] else Occlusion.NONE
        else:
            occlusion = Occlusion.of(visible) if 0 <= visible <= 1 else Occlusion.NONE
        yield Label(where, number, (x - first_px, y - first_px, w, h), occlusion, identity)


def _kitti(path: Path, text: str, _: Images) -> Iterator[Label]:
    """Read KITTI's labels of tracks: frame, id, type, truncated, occluded, alpha, corners, ....

    Frames and pixels count from 0; occluded is 0 no, 1 partly, 2 largely, 3 unknown; the id of
    ``DontCare`` is -1 (readme of its development kit).
    """
    for where, (number, identity, _type, *cells) in table_rows(path, text, 10):
        values = numbers_in(where, [number, identity, *cells[:7]])
        left, top, right, bottom = values[5:]
        if values[1] >= 0:
            occlusion = Occlusion.PARTIAL if values[3] in (1, 2) else Occlusion.NONE
            sides = (left, top, right - left, bottom - top)
            yield Label(where, values[0], sides, occlusion, values[1])


def _cvat(path: Path, text: str, images: Images) -> Iterator[Label]:
    """Read CVAT's XML, "for video" with tracks and "for images"; frames and pixels count from 0.

    ``outside`` is absent. Boxes between key frames are in the export (docs.cvat.ai, XML annotation
    format).
    """
    try:
        root = ElementTree.fromstring(text)  # noqa: S314 - expat bounds what entities expand to
    except ElementTree.ParseError as error:
        raise UnreadTruthError(f"{path} is not whole XML: {error}") from error
    if any(len(image.findall("box")) > 1 for image in root.iter("image")):
        raise UnreadTruthError(f"{path} has several boxes in an image, and no tracks")
    for parent, box in ((one, box) for one in root.iter() for box in one.findall("box")):
        where = f"{parent.tag} {parent.get('id')} of the truth {path}"
        stated = {**parent.attrib, **box.attrib}
        track, index, left, top, right, bottom, occluded, outside = (
            _number(where, name, stated.get(name))
            for name in ("id", "frame", "xtl", "ytl", "xbr", "ybr", "occluded", "outside")
        )
        if parent.tag == "image":
            track, index = 1, track
        number = images.names.get(stated.get("name", "").rpartition("/")[2])
        if number is None and index.is_integer():
            number = images.nth(int(index))
        sides = ABSENT if outside == 1 else (left, top, right - left, bottom - top)
        occlusion = Occlusion.PARTIAL if occluded == 1 else Occlusion.NONE
        yield Label(where, math.nan if number is None else number, sides, occlusion, track)


def _label_studio(path: Path, text: str, images: Images) -> Iterator[Label]:
    """Read Label Studio's export as JSON: rectangles of a video, or of images, one task each.

    Coordinates are in percent of the image (labelstud.io/tags/rectanglelabels).
    """
    width, height = images.size()
    try:
        for task in json.loads(text):
            done = [one["result"] for one in task["annotations"] if not one.get("was_cancelled")]
            regions = [one for one in (done or [[]])[0] if "rectangle" in one["type"]]
            for identity, region in enumerate(regions, start=1):
                where, value = f"region {identity} of the truth {path}", region["value"]
                is_video = "sequence" in value
                found = _key_frames if is_video else partial(_named, task["data"])
                for number, place in found(value, images):
                    if place.get("rotation"):
                        raise InputError(f"{where} is rotated; only upright boxes are read")
                    x, w = (place[name] * width / 100 for name in ("x", "width"))
                    y, h = (place[name] * height / 100 for name in ("y", "height"))
                    yield Label(where, number, (x, y, w, h), identity=identity)
    except (json.JSONDecodeError, LookupError, TypeError, AttributeError, RecursionError) as error:
        raise UnreadTruthError(f"{path} is not Label Studio's export as JSON") from error


def _named(
    data: Mapping[str, Any], value: Mapping[str, Any], images: Images
) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Yield the number of the image that a task names, perhaps with a prefix, and the box."""
    words = [word for one in data.values() for word in re.split(r"[/=]", str(one))]
    names = (name for word in words for name in (word, word.partition("-")[2]))
    for name in [name for name in names if name in images.names][:1]:
        yield images.names[name], value


def _key_frames(
    value: Mapping[str, Any], images: Images
) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Yield the numbers of a video's frames, which count from 1, and a region's boxes in them.

    A box moves linearly from one key frame to the next, but ends at one that is not ``enabled``.
    """
    last = min(value.get("framesCount") or 0, len(images.numbers))
    for now, following in pairwise([*value["sequence"], None]):
        frame = now["frame"]
        end = following["frame"] if following else max(last, frame) + 1
        for at in range(frame, end if now["enabled"] else frame + 1):
            share = (at - frame) / max(end - frame, 1) if following else 0.0
            then = following or now
            names = ("x", "y", "width", "height")
            place = {name: now[name] + share * (then[name] - now[name]) for name in names}
            yield images.nth(at - 1), {**place, "rotation": now.get("rotation", 0)}


Reader: TypeAlias = Callable[[Path, str, Images], Iterator[Label]]
_CELL = r"(?:[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|nan)"
_NEXT = rf"(?:{_GAP}{_CELL})"
FORMATS: Mapping[str, Reader] = {
    r"<.*": _cvat,
    r"[\[{].*": _label_studio,
    r"\d+\s+-?\d+\s+[a-z]+\s.*": _kitti,
    r"(?!nan\b)[a-z]+\s*,.*": _own,
    rf"{_CELL}{_NEXT}{{3}}(?:{_NEXT}{{4}})?[,;]?": in_order,
    rf"{_CELL}{_NEXT}{{5,}}(?:,.*)?": _mot,
}
"""The readers, by what the first line looks like; letters of either case."""
