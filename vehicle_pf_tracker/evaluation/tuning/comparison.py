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

"""Comparison of the best parameters with the initial ones, on tuned and held-out recordings."""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rich.table import Table
from rich.text import Text

from vehicle_pf_tracker.evaluation.evaluation_folder import read_document
from vehicle_pf_tracker.evaluation.grid.plan import Plan
from vehicle_pf_tracker.evaluation.tuning.searching import Objective, mean_of_means
from vehicle_pf_tracker.offline.run_folder import METRICS

TUNED, HELD_OUT = "tuned on", "held out"

Runs = Mapping[str, Sequence[float | None]]
"""A metric of each seed, by recording."""


@dataclass(frozen=True, slots=True)
class ComparedMetric:
    """A metric on one recording, or the mean over several.

    Attributes
    ----------
    part : str
        `TUNED` or `HELD_OUT`.
    recording : str
        Name of the recording; for a mean, the number of recordings.
    metric : str
        Name of the metric in `metrics.json`.
    base, best : float or None
        Mean over the seeds, and then over the recordings.
    base_spread, best_spread : float or None
        Standard deviation over the seeds; None for a mean over recordings.
    """

    part: str
    recording: str
    metric: str
    base: float | None
    best: float | None
    base_spread: float | None = None
    best_spread: float | None = None

    @property
    def change(self) -> float | None:
        """Difference of best minus base; None where either is unknown."""
        return None if self.base is None or self.best is None else self.best - self.base

    def to_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {**asdict(self), "change": self.change}


def compare(
    plan: Plan, folder: Path, held_out: Sequence[str], metrics: Sequence[str]
) -> list[ComparedMetric]:
    """Compare the two systems of `plan`, the base first, by their cells in `folder`.

    Parameters
    ----------
    plan : Plan
        Plan that was completed there.
    folder : Path
        Folder of the evaluation.
    held_out : sequence of str
        Names of the recordings that the search did not see.
    metrics : sequence of str
        Metrics to compare.
    """
    names = [source.name for source in plan.recordings]
    parts = {
        TUNED: [name for name in names if name not in held_out],
        HELD_OUT: [name for name in names if name in held_out],
    }
    return [
        line
        for metric in metrics
        for part, recordings in parts.items()
        if recordings
        for line in _lines(plan, folder, metric, part, recordings)
    ]


def _lines(
    plan: Plan, folder: Path, metric: str, part: str, recordings: Sequence[str]
) -> Iterator[ComparedMetric]:
    base, best = (_runs(plan, folder, system.label, metric) for system in plan.systems)
    for name in recordings:
        means = [mean_of_means({name: runs[name]}) for runs in (base, best)]
        spreads = [_spread(runs[name]) for runs in (base, best)]
        yield ComparedMetric(part, name, metric, *means, *spreads)
    over_all = [mean_of_means({name: runs[name] for name in recordings}) for runs in (base, best)]
    yield ComparedMetric(part, f"mean of {len(recordings)}", metric, *over_all)


def _runs(plan: Plan, folder: Path, label: str, metric: str) -> Runs:
    found: dict[str, list[float | None]] = {}
    for cell in plan.cells():
        if cell.system.label == label:
            path = cell.folder(folder) / METRICS
            value = read_document(path)[metric] if path.is_file() else None
            found.setdefault(cell.source.name, []).append(value)
    return found


def _spread(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return statistics.stdev(known) if len(known) > 1 else None


def to_markdown(lines: Sequence[ComparedMetric]) -> str:
    """Return the comparison as Markdown."""
    rows = [
        "| | recording | metric | default | best | change |",
        "|---|---|---|---:|---:|---:|",
        *(f"| {' | '.join(_cells(line))} |" for line in lines),
    ]
    return "\n".join(rows) + "\n"


def to_rich(lines: Sequence[ComparedMetric]) -> Table:
    """Return the comparison for a terminal."""
    table = Table()
    for name in ("", "recording", "metric"):
        table.add_column(name)
    for name in ("default", "best", "change"):
        table.add_column(name, justify="right")
    for line in lines:
        table.add_row(*map(Text, _cells(line)))
    return table


def _cells(line: ComparedMetric) -> tuple[str, ...]:
    change = "-" if line.change is None else f"{line.change:+.3f}"
    base = _number(line.base, line.base_spread)
    best = _number(line.best, line.best_spread)
    return line.part, line.recording, line.metric, base, best, change


def _number(value: float | None, spread: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.3f}" + ("" if spread is None else f" ± {spread:.3f}")


def verdict(lines: Sequence[ComparedMetric], objective: Objective) -> str:
    """State in a sentence whether the gain holds on held-out recordings."""
    change = {
        line.part: line.change
        for line in lines
        if line.metric == objective.metric and line.recording.startswith("mean of ")
    }
    gains = {
        part: None if value is None else value * (1 if objective.maximise else -1)
        for part, value in change.items()
    }
    tuned, held_out = gains.get(TUNED), gains.get(HELD_OUT)
    if tuned is None or tuned <= 0:
        return "With other seeds the best parameters are no better than those before."
    if HELD_OUT not in gains:
        return "Without --held-out nothing shows whether this holds on other recordings."
    if held_out is None or held_out <= 0:
        return "The gain does not hold on the recordings held out: this is over-fitted."
    if held_out >= tuned:
        return "The gain holds on the recordings held out."
    return f"On the recordings held out {held_out / tuned:.0%} of the gain is left."
