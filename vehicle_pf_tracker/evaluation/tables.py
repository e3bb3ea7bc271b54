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

"""Tables of results: text for a terminal, Markdown, CSV and a page."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_pf_tracker.evaluation.metrics import Metrics
from vehicle_pf_tracker.evaluation.occlusions import OcclusionScore

Cell: TypeAlias = float | int | bool | str | None
NOTHING = "-"
Rows: TypeAlias = list[list[str]]


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Make a Markdown table: the first column to the left, numbers to the right."""
    ruled = [header, ["---", *("---:" for _ in header[1:])], *rows]
    return "".join(
        f"| {' | '.join(cell.replace('|', '&#124;') for cell in row)} |\n" for row in ruled
    )


def csv_text(header: Sequence[str], rows: Iterable[Iterable[object]]) -> str:
    """Make a CSV file: every digit, and nothing for None."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


@dataclass(frozen=True, slots=True)
class Header:
    """A heading: its text, its unit, one sentence, and how many columns it spans."""

    text: str
    unit: str = ""
    note: str = ""
    span: int = 1


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell.

    Attributes
    ----------
    text : str
        Text of the cell.
    value : float or None
        Value it sorts by; None goes last.
    best : bool
        True if no other in its column is better.
    note : str
        Note shown on demand.
    """

    text: str
    value: float | None = None
    best: bool = False
    note: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of systems: its headings, and the cells of each system.

    `groups` spans the `headers`, and may be empty.
    """

    headers: Sequence[Header]
    rows: Mapping[str, Sequence[TableCell]]
    groups: Sequence[Header] = ()

    def texts(self) -> tuple[list[str], Rows]:
        """Return the headings with their units, and the text of all rows."""
        titles = [f"{h.text}, {h.unit}" if h.unit else h.text for h in self.headers]
        rows = [[label, *(cell.text for cell in cells)] for label, cells in self.rows.items()]
        return ["system", *titles], rows


@dataclass(frozen=True, slots=True)
class MetricRow:
    """A row: the metric and its unit, its cells, and the decimals that are shown."""

    label: str
    unit: str
    cells: tuple[Cell, ...]
    decimals: int = 1


@dataclass(frozen=True, slots=True)
class Comparison:
    """One line per metric, one column per run."""

    columns: tuple[str, ...]
    lines: tuple[MetricRow, ...]

    def texts(self) -> tuple[list[str], Rows]:
        """Return the headings, and the text of all rows."""
        rows = [[_label(line), *(_text(cell, line.decimals) for cell in line.cells)]
                for line in self.lines]  # fmt: skip
        return ["", *self.columns], rows

    def to_markdown(self) -> str:
        """Return the table as Markdown."""
        return markdown(*self.texts())

    def to_csv(self) -> str:
        """Return the table as CSV: every digit, and nothing where there is no value."""
        lines = ([line.label, line.unit, *line.cells] for line in self.lines)
        return csv_text(["metric", "unit", *self.columns], lines)


_LINES = (
    ("error, RMSE", "px", "rmse_px", 1),
    ("error, RMSE while visible", "px", "rmse_visible_px", 1),
    ("error, median", "px", "median_px", 1),
    ("error, largest", "px", "max_px", 1),
    ("error below 15 px", "share", "p_error_lt_15px", 3),
    ("on target while visible", "share", "on_target", 3),
    ("TRACKING while visible", "share", "visible_tracking", 3),
    ("not TRACKING while hidden", "share", "hidden_not_tracking", 3),
    ("frames", "", "frames", 1),
    ("frames scored", "", "frames_scored", 1),
    ("time per step, median", "ms", "step_ms_p50", 2),
    ("time per step, 95 %", "ms", "step_ms_p95", 2),
)
"""Label, unit, name of the metric and decimals; occlusions stand before the modes."""
_MODES = 6


def comparison(runs: Mapping[str, Metrics]) -> Comparison:
    """Put runs on the same recording side by side, each under its name.

    Metrics that no run has are left out.
    """
    metrics = list(runs.values())
    lines = [
        MetricRow(label, unit, tuple(getattr(run, name) for run in metrics), decimals)
        for label, unit, name, decimals in _LINES
    ]
    lines[_MODES:_MODES] = _occlusion_lines(metrics)
    kept = (line for line in lines if any(cell is not None for cell in line.cells))
    return Comparison(tuple(runs), tuple(kept))


def _occlusion_lines(metrics: list[Metrics]) -> list[MetricRow]:
    # Runs that were started at different frames may not have seen the same occlusions.
    by_frames = [{(o.first_frame, o.last_frame): o for o in m.occlusions} for m in metrics]
    lines = []
    for first, last in sorted(set().union(*by_frames)):
        found = [table.get((first, last)) for table in by_frames]
        name = f"hidden {first}-{last}"
        inside = tuple(o.error_inside_px if o else None for o in found)
        after = tuple(o.error_after_px if o else None for o in found)
        lines += [
            MetricRow(f"{name}: mean error inside", "px", inside),
            MetricRow(f"{name}: mean error after", "px", after),
            MetricRow(f"{name}: recovered", "", tuple(map(_verdict, found))),
        ]
    return lines


def _verdict(occlusion: OcclusionScore | None) -> Cell:
    if occlusion is None:
        return None
    return "not judged" if occlusion.recovered is None else occlusion.recovered


def _label(line: MetricRow) -> str:
    return f"{line.label}, {line.unit}" if line.unit not in {"", "share"} else line.label


def _text(cell: Cell, decimals: int) -> str:
    if cell is None:
        return NOTHING
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return f"{cell:.{decimals}f}" if isinstance(cell, float) else str(cell)
