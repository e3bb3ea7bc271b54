# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tables that a run over many vehicles has written, read for programs and notebooks."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.results.traffic_results import COUNTS_FILE, TRACKS_FILE, ZONES

_INTEGERS = {"frame", "stamp_ns", "id", "max"}
"""Columns that are read as integers: a stamp in ns has more digits than a float."""
_TEXTS = {"mode", "label", "hidden_by", "place", "zone", "direction", "doubt"}
"""Columns that are read as text; all others are floats."""


def read_tracks(folder: str | Path, *, pandas: bool = False) -> Any:
    """Read ``tracks.csv`` of a folder that `traffic` has written.

    Parameters
    ----------
    folder : str or Path
        The folder.
    pandas : bool
        Return a data frame instead.

    Returns
    -------
    numpy.recarray or pandas.DataFrame
        A row for each vehicle and frame, with the columns of the file; NaN where it has no number.

    Raises
    ------
    InputError
        If it cannot be read, or pandas is not installed.
    """
    return _read(Path(folder) / TRACKS_FILE, pandas)


def read_counts(folder: str | Path, *, pandas: bool = False) -> Any:
    """Read ``counts.csv``, a row for each crossing; see `read_tracks`."""
    return _read(Path(folder) / COUNTS_FILE, pandas)


def read_zones(folder: str | Path, *, pandas: bool = False) -> Any:
    """Read ``zones.csv``, a row for each zone and interval; see `read_tracks`."""
    return _read(Path(folder) / ZONES, pandas)


def _read(path: Path, as_frame: bool) -> Any:
    """Read a table by columns, as a record array or a data frame."""
    lines = list(csv.reader(read_text(path, "the table").splitlines()))
    if not lines:
        raise InputError(f"the table {path} is empty")
    names, *rows = lines
    try:
        columns = {
            name: _column(name, [row[index] for row in rows]) for index, name in enumerate(names)
        }
    except (ValueError, IndexError) as error:
        raise InputError(f"cannot read the table {path}: {error}") from None
    if not as_frame:
        kinds = [(name, column.dtype) for name, column in columns.items()]
        return np.rec.fromarrays(list(columns.values()), dtype=np.dtype(kinds))
    try:
        from pandas import DataFrame  # noqa: PLC0415 - no dependency of ours
    except ImportError:
        raise InputError("a data frame needs pandas: pip install pandas") from None
    return DataFrame(columns)


def _column(name: str, cells: list[str]) -> Any:
    if name in _TEXTS:
        return np.array(cells, str)
    return np.array([cell or "nan" for cell in cells], np.int64 if name in _INTEGERS else float)
