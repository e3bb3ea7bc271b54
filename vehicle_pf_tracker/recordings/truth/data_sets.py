# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth of data sets: a row per image, or a row per target and image."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from itertools import zip_longest
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.recordings.text_tables import cells_of, number_of, numbers_in, table_rows
from vehicle_pf_tracker.recordings.truth.labels import ABSENT_SIDES, Images, Label

_REQUIRED = ("frame", "x", "y", "w", "h")
_PRESENCE: Mapping[float, Occlusion | None] = {1.0: None}
"""Meaning of a flag that says the vehicle is not in view: a frame without truth."""
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
            # A flag that the table does not have, as 0, says nothing: not occluded.
            columns.append([meaning.get(flag, Occlusion.NONE) for flag in _list(path)])
    # Flags may contradict each other: absent wins, then the more hidden.
    # The longest file decides: where another ends before, it says nothing more.
    states = (set(row) for row in zip_longest(*columns, fillvalue=Occlusion.NONE))
    return [None if None in state else max(state - {None}) for state in states]  # type: ignore[type-var]


def own(path: Path, text: str, _: Images) -> Iterator[Label]:
    """Read our table: frame,x,y,w,h, and perhaps visible (0: not at all) and occ (0, 1 or 2).

    Its first line names the columns, in any order and beside others, as of row numbers.
    """
    rows = table_rows(path, text, 1)
    names = [name.lower() for name in next(rows)[1]]
    if lacking := [name for name in _REQUIRED if name not in names]:
        raise InputError(
            f"the truth {path} lacks the column {lacking[0]}; its first line names them"
        )
    for where, row in rows:
        if len(row) > len(names):
            raise InputError(f"{where} has {len(row)} cells, the first line names {len(names)}")
        cells = dict(zip(names, row, strict=False))
        number, x, y, w, h = (number_of(where, name, cells.get(name)) for name in _REQUIRED)
        occlusion = number_of(where, "occ", cells.get("occ"))
        # "Not visible" wins over a degree of occlusion.
        if number_of(where, "visible", cells.get("visible")) == 0:
            occlusion = Occlusion.TOTAL
        if not math.isnan(occlusion) and occlusion not in set(Occlusion):
            raise InputError(f"{where} has occ {occlusion:g}; it must be 0, 1 or 2")
        state = Occlusion.NONE if math.isnan(occlusion) else Occlusion(int(occlusion))
        yield Label(where, number, (x, y, w, h), state)


def _list(path: Path) -> list[float]:
    """Read a file of numbers alone, of one line or several."""
    lines = read_text(path, "the truth").splitlines()
    return [value for line in lines for value in numbers_in(f"the truth {path}", cells_of(line))]


def in_order(path: Path, text: str, images: Images) -> Iterator[Label]:
    """Read a box or a polygon per image: OTB, TC128, UAV123, LaSOT, GOT-10k, UAVDT-S and VOT.

    Boxes count pixels from 1: the toolkits of OTB, TC128, UAV123 and UAVDT are MATLAB's; for LaSOT
    see issue 14 of its toolkit, for GOT-10k issue 6. VOT's boxes (beside its file ``sequence``) and
    polygons stay as they are, as in its toolkit; of a polygon the upright hull is taken.
    TC128's ``NAME_frames.txt`` has the numbers of the first and the last image.
    """
    folder = path.parent
    begin = 0
    # One pixel more or less is a tenth of the width of a far vehicle.
    first_px = 0 if (folder / "sequence").is_file() or any(folder.glob("*.tag")) else 1
    span = folder / path.name.replace("_gt.", "_frames.")
    if span != path and span.is_file():
        first = next(iter(_list(span)), 1)
        begin = images.numbers.index(int(first)) if first in images.numbers else 0
    ending = re.search(r"^groundtruth.*[._](\d+)$", path.stem)
    flags = _flags(folder)
    for index, (where, cells) in enumerate(table_rows(path, text, 1)):
        values = numbers_in(where, cells)
        state = flags[index] if index < len(flags) else Occlusion.NONE
        if len(values) not in (1, 4, 8):
            raise InputError(f"{where} has {len(values)} numbers; a box has 4, a polygon 8")
        if state is None or len(values) == 1:  # a single number is VOT's code for no box
            sides = ABSENT_SIDES
        elif len(values) == 4:
            sides = (values[0] - first_px, values[1] - first_px, values[2], values[3])
        else:
            xs = values[::2]
            ys = values[1::2]
            sides = (min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys))
        identity = int(ending.group(1)) if ending else 1
        yield Label(where, images.nth(begin + index), sides, state or Occlusion.NONE, identity)


def mot(path: Path, text: str, _: Images) -> Iterator[Label]:
    """Read MOTChallenge's rows, frame,id,left,top,width,height,conf,class,visibility, and UAVDT's.

    Frames and pixels count from 1 (motchallenge.net/instructions), but pixels from 0 in what CVAT
    and our `synth` write, with ``labels.txt`` or ``occluders.csv`` beside. UAVDT's ``gt_whole``
    ends in out of view, occlusion (1 none, 2 large to 4 small) and class.
    """
    others = [path.with_name(name) for name in ("labels.txt", "occluders.csv")]
    first_px = 0 if any(other.is_file() for other in others) else 1
    is_uavdt = path.stem.endswith("_gt_whole")
    for where, cells in table_rows(path, text, 6):
        number, identity, x, y, w, h, *rest = numbers_in(where, cells)
        visible = rest[2] if len(rest) > 2 else 1.0
        if is_uavdt:
            # Lists, so that a row without the column compares, and is not occluded.
            occlusion = Occlusion.PARTIAL if rest[1:2] > [1.0] else Occlusion.NONE
        else:
            # Other data sets have -1 or a class there: no share, and so unknown.
            occlusion = Occlusion.of(visible) if 0 <= visible <= 1 else Occlusion.NONE
        yield Label(where, number, (x - first_px, y - first_px, w, h), occlusion, identity)


def kitti(path: Path, text: str, _: Images) -> Iterator[Label]:
    """Read KITTI's labels of tracks: frame, id, type, truncated, occluded, alpha, corners, ....

    Frames and pixels count from 0; occluded is 0 no, 1 partly, 2 largely, 3 unknown; the id of
    ``DontCare`` is -1 (readme of its development kit).
    """
    for where, (number, identity, _type, *cells) in table_rows(path, text, 10):
        # Of the ten cells before the 3D box the type, which is a word, is left out.
        values = numbers_in(where, [number, identity, *cells[:7]])
        left, top, right, bottom = values[5:]
        # Regions of ``DontCare`` are no target.
        if values[1] >= 0:
            occlusion = Occlusion.PARTIAL if values[3] in (1, 2) else Occlusion.NONE
            sides = (left, top, right - left, bottom - top)
            yield Label(where, values[0], sides, occlusion, values[1])
