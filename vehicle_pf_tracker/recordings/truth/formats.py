# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The formats of truth, recognised by the first line of a file.

Each reader yields the labels that a file states, in our coordinates: the first pixel begins at 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.text_tables import cells_of, is_number
from vehicle_pf_tracker.recordings.truth.annotation_tools import cvat, label_studio
from vehicle_pf_tracker.recordings.truth.data_sets import in_order, kitti, mot, own
from vehicle_pf_tracker.recordings.truth.labels import Reader, UnreadTruthError

Test: TypeAlias = Callable[[Sequence[str]], bool]
"""Decides by the cells of the first line."""


def _is_kitti(cells: Sequence[str]) -> bool:
    return len(cells) >= 10 and all(map(is_number, cells[:2])) and cells[2].isalpha()


def _is_own(cells: Sequence[str]) -> bool:
    names = [cell.lower() for cell in cells]
    return "frame" in names or (len(names) >= 4 and names[0].isalpha() and names[0] != "nan")


def _is_in_order(cells: Sequence[str]) -> bool:
    return len(cells) in {4, 8} and all(map(is_number, cells))


def _is_mot(cells: Sequence[str]) -> bool:
    return len(cells) >= 6 and all(map(is_number, cells[:6]))


MARKS: Mapping[str, Reader] = {"<": cvat, "[": label_studio, "{": label_studio}
"""The readers of documents, by the first letter."""
FORMATS: Mapping[Reader, Test] = {
    # In this order: eight numbers are a polygon rather than MOTChallenge's, but in ``gt.txt``; and
    # KITTI's third cell is a word, unlike that of all others.
    kitti: _is_kitti,
    own: _is_own,
    in_order: _is_in_order,
    mot: _is_mot,
}
"""The readers of tables, the first whose test the first line passes."""


def reader_of(path: Path, text: str) -> Reader:
    """Return the reader of a file of truth.

    Raises
    ------
    UnreadTruthError
        If it is in no known format.
    InputError
        If it is empty.
    """
    lines = (line.strip() for line in text.splitlines())
    first = next((line for line in lines if line and not line.startswith("#")), None)
    if first is None:
        raise InputError(f"the truth {path} is empty")
    # Document formats have no table to look at: their first letter is enough.
    if first[0] in MARKS:
        return MARKS[first[0]]
    cells = cells_of(first)
    if path.name == "gt.txt" and _is_mot(cells):  # of eight numbers, too
        return mot
    for reader, fits in FORMATS.items():
        if fits(cells):
            return reader
    raise UnreadTruthError(f"{path} looks like truth, but is in no format that is read")
