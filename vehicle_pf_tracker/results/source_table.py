# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The table over the results of many sources: a row for each vehicle that was given, or source."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.results.estimates import read_estimates
from vehicle_pf_tracker.results.run_folder import ESTIMATES_FILE, METRICS_FILE, RUN_FILE

SOURCE_FILE = "source.json"
"""File in the folder of a source: its name, the key of its results, and why they are not whole."""
NAME = "source"
"""First column."""
_REASON = "failed"
"""Last column: why a source has no results."""
_FOLLOWED = ("frames", "tracked", "occluded", "lost")
"""Columns of a run of `run`: its frames, and those in each mode."""
_SCORES = ("on_target", "median_px", "success_auc")
"""Metrics that are shown where there is truth; `metrics.json` has the others."""
_LARGEST = "most_at_once"
"""Column whose largest value stands for all sources; others are summed."""
_NO_TOTAL = (*_SCORES, "least_size_px")
"""Columns that nothing stands for: medians and shares of one source each."""

Cell: TypeAlias = "str | int | float | None"
"""Cell of the table; None where there is no value."""


@dataclass(frozen=True, slots=True)
class SourceTable:
    """Results of many sources.

    Attributes
    ----------
    header : list of str
        Names of the columns, first that of the source, last that of the reason for a failure.
    rows : list of list
        Cells; None where there is no value.
    failures : dict of str to str
        Reasons by the names of the sources that failed.
    """

    header: list[str]
    rows: list[list[Cell]]
    failures: dict[str, str]

    @property
    def totals(self) -> list[Cell]:
        """Row of all sources together."""
        columns = zip(self.header, zip(*self.rows, strict=True), strict=True)
        return ["all", *(_total(name, cells) for name, cells in list(columns)[1:])]


def read_table(folder: Path, names: Sequence[str]) -> SourceTable:
    """Read the table of the sources that have results, or a reason for none, below a folder.

    Parameters
    ----------
    folder : Path
        Folder over all.
    names : sequence of str
        Folders of the sources in it.

    Raises
    ------
    InputError
        If a file cannot be read.
    """
    rows: list[dict[str, Cell]] = []
    failures = {}
    for name in names:
        facts = _document(folder / name / SOURCE_FILE)
        if facts is None:
            continue
        if facts["reason"]:
            failures[name] = facts["reason"]
        values = dict(_values(folder / name)) or {"": {}}
        rows += [
            {NAME: f"{name}/{part}" if part else name, **of_part, _REASON: facts["reason"]}
            for part, of_part in values.items()
        ]
    columns = dict.fromkeys(column for row in rows for column in row if column != _REASON)
    header = [*(columns or [NAME]), _REASON]
    return SourceTable(header, [[row.get(column) for column in header] for row in rows], failures)


def _values(folder: Path) -> Iterator[tuple[str, dict[str, Cell]]]:
    """Give what is shown of each run in a folder, by the name of the vehicle if it has several."""
    for path in sorted(folder.rglob(RUN_FILE)):
        at = path.parent
        document = _document(path) or {}
        part = "" if at == folder else at.relative_to(folder).as_posix()
        if "summary" in document:
            yield part, _of_traffic(document["summary"])
        elif (at / ESTIMATES_FILE).exists():
            modes = Counter(row.mode.lower() for row in read_estimates(at / ESTIMATES_FILE))
            tallies = modes.total(), modes["tracking"], modes["occluded"], modes["lost"]
            metrics = _document(at / METRICS_FILE) or {}
            scores = {name: metrics[name] for name in _SCORES if name in metrics}
            yield part, {**dict(zip(_FOLLOWED, tallies, strict=True)), **scores}


def _of_traffic(summary: Mapping[str, Any]) -> dict[str, Cell]:
    """Return the numbers of a summary, and its counts by place and direction."""
    numbers = {name: value for name, value in summary.items() if isinstance(value, int | float)}
    counts: Counter[str] = Counter()
    for entry in summary["counts"]:
        counts[f"{entry['place']} {entry['direction']}"] += entry["count"]
    return {**numbers, **counts}


def _total(name: str, cells: Sequence[Cell]) -> Cell:
    numbers = [cell for cell in cells if isinstance(cell, int | float)]
    if name in _NO_TOTAL or not numbers:
        return ""
    return max(numbers) if name == _LARGEST else sum(numbers)


def _document(path: Path) -> Any:
    """Return the content of a JSON file; None where there is no such file."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None
