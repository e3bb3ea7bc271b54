# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth as it lies beside images: where its files are, and the rows of one target."""

from __future__ import annotations

import glob
import math
from collections.abc import Mapping, Sequence
from enum import Enum
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.recordings.box_sizes import misfit
from vehicle_pf_tracker.recordings.footage import LARGEST_PX
from vehicle_pf_tracker.recordings.truth.data_sets import in_order
from vehicle_pf_tracker.recordings.truth.formats import reader_of
from vehicle_pf_tracker.recordings.truth.labels import OTHER_SHAPES, Images, Label, UnreadTruthError

_IDS_SHOWN = 20
"""Identities that an error lists: more are hard to read on a terminal."""
_LARGEST_INTEGER = 2**53
"""Largest integer up to which floats are exact; frames and targets are read as floats."""
_OWN = "groundtruth.csv"
_ANYTHING = ("*groundtruth*", "*annotation*")
"""Files that may hold truth; those that do are read."""
_PLACES = (
    _OWN,
    "groundtruth_rect.txt",  # OTB
    "groundtruth.txt",  # VOT, LaSOT, GOT-10k
    "groundtruth*[._][0-9].txt",  # OTB and VOT, several targets
    "{name}_gt.txt",  # TC128
    "gt/gt.txt",  # MOTChallenge
    "annotations.xml",  # CVAT
    "project-*.json",  # Label Studio
    "../anno/{name}.txt",
    "../../../anno/{parent}/{name}.txt",  # UAV123: data_seq/UAV123/NAME, anno/UAV123/NAME.txt
    "../../label_02/{name}.txt",  # KITTI: image_02/NAME
    "../../*/anno/{name}_gt.txt",  # UAVDT-S: UAV-benchmark-S/NAME, .../anno/NAME_gt.txt
    "../../*/GT/{name}_gt_whole.txt",  # UAVDT-M
    *_ANYTHING,
)
"""Patterns of the files of truth, from the folder of the images."""
_PARTS = ("../anno/{name}_[0-9].txt", "../../../anno/{parent}/{name}_[0-9].txt")
"""UAV123's truth of parts of a video. The images where they begin stand in its toolkit alone."""


class SeveralVehiclesError(UnreadTruthError):
    """Raised for truth of several vehicles of which none was chosen."""


class NoSuchTargetError(InputError):
    """Raised where the truth does not have the target that was asked for."""


class Beside(str, Enum):
    """Use of the truth that lies beside images: a fault is an error, or a notice, or none read."""

    NEEDED = "needed"
    NOTED = "noted"
    IGNORED = "ignored"


Table = dict[int, Truth]
"""Truth by the number of its image, whose stamp it has yet to be given."""


def truth_beside(
    folder: Path, images: Images, identity: int | None = None, use: Beside = Beside.NEEDED
) -> tuple[Table, list[str]]:
    """Read the truth that lies with the images in `folder`.

    Returns
    -------
    table : dict of int to Truth
        The truth by the number of its image; empty where there is none.
    notices : list of str
        What was read, and what was seen and not read, a sentence each.

    Raises
    ------
    InputError
        If truth is needed, and what is named as truth has a fault or several vehicles. A target
        `identity` that is not there is always an error.
    """
    if use is Beside.IGNORED:
        return {}, []
    # Resolved: `.` has no name, and patterns with ``..`` go by the folder's own.
    folder = folder.resolve()
    notices = list[str]()
    seen: set[Path] = set()
    for pattern in _PLACES:
        # Patterns overlap, and a file that was read and refused is refused once.
        paths = [path for path in _at(folder, pattern) if path not in seen]
        seen.update(paths)
        try:
            if paths:
                table, said = read_truth(paths, images, identity)
                # Of our own file nothing is said: it lies where it should.
                read = [f"the truth is read from {paths[0]}"] if pattern != _OWN else []
                return table, [*notices, *read, *said]
        except InputError as error:
            if (use is Beside.NEEDED and _is_fault(error, pattern)) or isinstance(
                error, NoSuchTargetError
            ):
                raise
            notices.append(str(error))
    if parts := [path for pattern in _PARTS for path in _at(folder, pattern)]:
        notices.append(
            f"{parts[0]} is the truth of a part of a video, which does not state its first image, "
            "and is not read; give the part a folder of its name"
        )
    return {}, notices


def _at(folder: Path, pattern: str) -> list[Path]:
    """Return the files that a pattern of `_PLACES` names, but hidden ones."""
    # Escaped: a folder may have a * or [ in its name.
    names = {"name": glob.escape(folder.name), "parent": glob.escape(folder.parent.name)}
    paths = folder.glob(pattern.format_map(names))
    return sorted(path for path in paths if not path.name.startswith("."))


def _is_fault(error: InputError, pattern: str) -> bool:
    """Return whether an error of the file at `pattern` is more than that it is no truth."""
    if isinstance(error, SeveralVehiclesError):
        return True
    is_unread = isinstance(error, UnreadTruthError) and pattern != _OWN
    return not is_unread and pattern not in _ANYTHING


def read_truth(
    paths: Sequence[Path], images: Images, identity: int | None = None
) -> tuple[Table, list[str]]:
    """Read the truth of a target, by the number of the image, and say what is irregular.

    Several files are of one target each, the number that ends a file's name.

    Raises
    ------
    UnreadTruthError
        If a file is in no known format or holds no box, or there are several targets and no
        `identity`.
    InputError
        If a file cannot be read, names a frame twice, or has a cell that is not a number; or if
        there is no target `identity`, or it is not an upright box; or if none of its frames has an
        image, or none of its boxes lies in them.
    """
    targets: dict[int, dict[int, Truth | None]] = {}
    faults: dict[int, str] = {}
    notices = []
    for path in paths:
        text = read_text(path, "the truth")
        reader = reader_of(path, text)
        labels = list(reader(path, text, images))
        # Rows without a number are counted from the first image; with fewer rows that is a guess.
        if reader is in_order and labels and len(labels) < len(images.names):
            notices.append(
                f"{path} has {len(labels)} rows for {len(images.names)} images; its first is "
                f"taken for image {labels[0].number:g}"
            )
        for label in labels:
            _put(label, targets, faults)
    # A fault of the chosen target is an error; those of others are notices.
    chosen = _chosen(targets, faults, paths[0], identity)
    if fault := faults.pop(chosen, ""):
        raise InputError(fault)
    if faults:
        first = next(iter(faults.values()))
        notices.append(f"of the truth {len(faults)} targets or shapes are not read: {first}")
    table = {number: row for number, row in targets[chosen].items() if row is not None}
    if not table:
        raise UnreadTruthError(f"the truth {paths[0]} holds no box")
    return table, [*notices, *_check_fit(table, paths[0], images)]


def _put(label: Label, targets: dict[int, dict[int, Truth | None]], faults: dict[int, str]) -> None:
    """Add a label to the rows of its target; one that is not read to the faults."""
    if label.fault:
        faults.setdefault(_whole(label, label.identity, "target"), f"{label.where} {label.fault}")
        return
    number, target, row = _row(label)
    rows = targets.setdefault(target, {})
    # The end of a track may be written twice: absent and absent is no contradiction.
    if number in rows and not (row is None and rows[number] is None):
        raise InputError(f"{label.where} names frame {number} a second time")
    rows[number] = row


def _chosen(
    targets: Mapping[int, object], faults: Mapping[int, str], path: Path, identity: int | None
) -> int:
    """Return the target that was asked for, or the only one."""
    # Shapes without a number cannot be asked for, and are none of the known targets.
    known = {*targets, *faults} - {OTHER_SHAPES} if identity is not None else {*targets}
    listed = ", ".join([*map(str, sorted(known)[:_IDS_SHOWN]), "..."][: len(known)])
    if identity is None and len(known) > 1:
        raise SeveralVehiclesError(
            f"{path} has the truth of {len(known)} vehicles; choose one with --id: {listed}"
        )
    if identity is not None and identity not in known:
        raise NoSuchTargetError(f"the truth {path} has no target {identity}; it has {listed}")
    if not known and faults:
        raise InputError(next(iter(faults.values())))
    if not known:
        raise UnreadTruthError(f"the truth {path} holds no box")
    return next(iter(known)) if identity is None else identity


def _check_fit(table: Table, path: Path, images: Images) -> list[str]:
    """Refuse truth of other images: of none that is there, or none of whose boxes lies in them."""
    # A video has a range of up to a million numbers, which needs no set.
    numbers = images.numbers if isinstance(images.numbers, range) else set(images.numbers)
    if not any(number in numbers for number in table):
        raise InputError(
            f"no frame of the truth {path} has an image: it has frames {min(table)} to "
            f"{max(table)}, the images are {min(numbers)} to {max(numbers)}"
        )
    notices = []
    if isinstance(images.numbers, range) and min(table) < images.numbers[0]:
        notices.append(f"the truth {path} has frame {min(table)}; frames of a video count from 1")
    try:
        size = images.size()
    except InputError:  # of an image that cannot be read, which is said elsewhere
        return notices
    boxes = [(row.box.x, row.box.y, row.box.width, row.box.height) for row in table.values()]
    doubt = misfit(np.array(boxes), size)
    if doubt is None:
        return notices
    if doubt.is_fatal:
        raise InputError(f"the truth {path} does not fit the images: {doubt.sentence}")
    return [*notices, f"the truth {path} may not fit the images: {doubt.sentence}"]


def _row(label: Label) -> tuple[int, int, Truth | None]:
    """Return frame and target of a label, and its row; None where the target is absent."""
    number = _whole(label, label.number, "frame")
    target = _whole(label, label.identity, "target")
    if any(abs(value) > LARGEST_PX for value in label.sides if math.isfinite(value)):
        raise InputError(f"{label.where} has a box beyond {LARGEST_PX:.0f} px")
    # Without an area, or with NaN: absent. A row all the same, as it may not be named twice.
    is_box = all(map(math.isfinite, label.sides)) and min(label.sides[2:]) > 0
    row = Truth(0, Box(*label.sides), label.occlusion) if is_box else None
    return number, target, row


def _whole(label: Label, value: float, name: str) -> int:
    if not float(value).is_integer() or abs(value) > _LARGEST_INTEGER:
        raise InputError(f"{label.where} has no integer as its {name}")
    return int(value)
