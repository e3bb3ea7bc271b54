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

"""Tables of results: text for a terminal, Markdown and a page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_pf_tracker.evaluation.metrics import Metrics
from vehicle_pf_tracker.evaluation.scores import OcclusionScore

NOTHING = "-"
Rows: TypeAlias = list[list[str]]


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Make a Markdown table: the first column to the left, numbers to the right."""
    ruled = [header, ["---", *("---:" for _ in header[1:])], *rows]
    return "".join(
        f"| {' | '.join(cell.replace('|', '&#124;') for cell in row)} |\n" for row in ruled
    )


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


_LINES = (
    ("error, RMSE, px", "rmse_px", 1),
    ("error, RMSE while visible, px", "rmse_visible_px", 1),
    ("error, median, px", "median_px", 1),
    ("error, largest, px", "max_px", 1),
    ("error below 15 px", "p_error_lt_15px", 3),
    ("on target while visible", "on_target", 3),
    ("TRACKING while visible", "visible_tracking", 3),
    ("not TRACKING while hidden", "hidden_not_tracking", 3),
    ("frames", "frames", 0),
    ("frames scored", "frames_scored", 0),
    ("time per step, median, ms", "step_ms_p50", 2),
    ("time per step, 95 %, ms", "step_ms_p95", 2),
)
"""Label, name of the metric and decimals; occlusions stand before the modes."""
_MODES = 6


def run_rows(metrics: Metrics) -> Rows:
    """Return a row for each metric that the run has: its label with the unit, and its value."""
    values = [(label, getattr(metrics, name), decimals) for label, name, decimals in _LINES]
    values[_MODES:_MODES] = [line for one in metrics.occlusions for line in _occlusion_lines(one)]
    return [[label, _text(value, decimals)] for label, value, decimals in values
            if value is not None]  # fmt: skip


def _occlusion_lines(one: OcclusionScore) -> Iterator[tuple[str, float | str | None, int]]:
    name = f"hidden {one.first_frame}-{one.last_frame}"
    yield f"{name}: mean error inside, px", one.error_inside_px, 1
    yield f"{name}: mean error after, px", one.error_after_px, 1
    recovered = "not judged" if one.recovered is None else "yes" if one.recovered else "no"
    yield f"{name}: recovered", recovered, 0


def _text(value: float | str, decimals: int) -> str:
    return value if isinstance(value, str) else f"{value:.{decimals}f}"
