"""The `groundtruth.csv` of a frame folder."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion

_REQUIRED = ("frame", "x", "y", "w", "h")


@dataclass(frozen=True, slots=True)
class TruthRow:
    """The vehicle's box (px) in a frame, and how far it is hidden."""

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
        cell that is no number.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as stream:
            return _rows(path, csv.DictReader(stream))
    except OSError as error:
        raise InputError(f"cannot read the truth {path}: {error.strerror}") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"the truth {path} is no table of text: {error}") from error


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
        place = f"line {reader.line_num} of the truth {path}"
        number, row = _row(place, cells)
        if number in seen:
            raise InputError(f"{place} names frame {number} a second time")
        seen.add(number)
        if row is not None:
            table[number] = row
    if not table:
        raise InputError(f"the truth {path} holds no box")
    return table


def _row(place: str, cells: dict[str, str]) -> tuple[int, TruthRow | None]:
    frame, x, y, width, height = (_number(place, name, cells.get(name)) for name in _REQUIRED)
    if not frame.is_integer():
        raise InputError(f"{place} has no whole number as its frame")
    values = (x, y, width, height)
    if not all(map(math.isfinite, values)) or width <= 0 or height <= 0:
        return int(frame), None
    return int(frame), TruthRow(Box(*values), _occlusion(place, cells))


def _occlusion(place: str, cells: dict[str, str]) -> Occlusion:
    if _number(place, "visible", cells.get("visible")) == 0:
        return Occlusion.TOTAL
    occlusion = _number(place, "occ", cells.get("occ"))
    if math.isnan(occlusion):
        return Occlusion.NONE
    if occlusion not in set(Occlusion):
        raise InputError(f"{place} has occ {occlusion:g}; it must be 0, 1 or 2")
    return Occlusion(int(occlusion))


def _number(place: str, name: str, cell: str | None) -> float:
    """Read a cell; an empty or missing one is NaN."""
    if cell is None or not cell.strip():
        return math.nan
    try:
        return float(cell)
    except ValueError:
        raise InputError(f"{place} has {cell!r} as {name}, which is no number") from None
