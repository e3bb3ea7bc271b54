# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tables in text files: lines of cells, whichever separator, quotes and decimal sign they use.

Not by `numpy.loadtxt` or `genfromtxt`: these take one separator for a whole file, no decimal comma
beside it, and name no cell that is wrong.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError

_SHOWN = 60
"""Letters of a bad cell that an error shows: a line of a terminal has 80."""
_QUOTED = re.compile(r'"[^"]*"')
_DECIMAL_COMMA = re.compile(r"[-+]?[0-9]*,[0-9]+(?:[eE][-+]?[0-9]+)?")
_FEWEST_CELLS = 4
"""Cells of the shortest tables, a box: tabs that make fewer only follow commas."""


def cells_of(line: str) -> list[str]:
    """Return the cells of a line, without quotes; none of an empty line.

    Cells are apart by semicolons, else tabs, else commas, else spaces. Between semicolons or tabs a
    comma is a decimal comma, as in what spreadsheets write in most of Europe.
    """
    # A separator at the end is followed by no cell, and is common in exports.
    words = line.strip().rstrip(" \t,;")
    if not words:
        return []
    # What is in quotes does not decide: a name may have a comma in it.
    delimiter = _delimiter(_QUOTED.sub("", words) if '"' in words else words)
    if '"' in words:
        try:
            cells = next(csv.reader([words], delimiter=delimiter, skipinitialspace=True))
        except csv.Error:  # as of a cell of a megabyte
            return [words]
    else:
        cells = words.split() if delimiter == " " else words.split(delimiter)
    cells = [cell.strip() for cell in cells]
    # Commas between the separators: at a cell's end they are left over, within a number decimal.
    if delimiter in ";\t" and "," in words:
        cells = [cell.strip(" ,") for cell in cells]
        cells = [c.replace(",", ".") if _DECIMAL_COMMA.fullmatch(c) else c for c in cells]
    return cells


def _delimiter(words: str) -> str:
    if ";" in words:
        return ";"
    # Tabs before commas only where they make a table by themselves.
    if "\t" in words and ("," not in words or words.count("\t") + 1 >= _FEWEST_CELLS):
        return "\t"
    return "," if "," in words else " "


def table_rows(
    path: Path, text: str, least: int, what: str = "the truth"
) -> Iterator[tuple[str, list[str]]]:
    """Yield the place and the cells, at least so many, of each line but comments and empty ones.

    A comment begins with ``#``.

    Raises
    ------
    InputError
        If a line has fewer cells.
    """
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("#"):
            continue
        if cells := cells_of(line):
            where = f"line {number} of {what} {path}"
            if len(cells) < least:
                # Here and not where the cells are read: the place is still known.
                raise InputError(f"{where} has {len(cells)} cells, of at least {least}")
            yield where, cells


def number_of(where: str, name: str, cell: str | None) -> float:
    """Read a cell; an empty or missing one is NaN.

    Raises
    ------
    InputError
        If it is not a number.
    """
    if cell is None or not cell.strip():
        return math.nan
    try:
        return float(cell)
    except ValueError:
        raise InputError(
            f"{where} has {cell[:_SHOWN]!r} as {name}, which is not a number"
        ) from None


def numbers_in(where: str, cells: Sequence[str]) -> list[float]:
    """Read cells; an empty one is NaN."""
    return [number_of(where, f"number {place}", cell) for place, cell in enumerate(cells, start=1)]


def is_number(cell: str) -> bool:
    """Return whether a cell is a finite number or ``nan``."""
    try:
        return not math.isinf(float(cell))
    except ValueError:
        return False
