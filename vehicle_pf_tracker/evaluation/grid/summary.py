"""The grid in one table: what each system is worth over all recordings and seeds."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.table import Table
from rich.text import Text

from vehicle_pf_tracker.evaluation.evaluation_folder import FAILED, read_document
from vehicle_pf_tracker.evaluation.grid.cells import GridCell
from vehicle_pf_tracker.evaluation.grid.plan import Plan
from vehicle_pf_tracker.evaluation.results import METRICS

Document = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class SystemSummary:
    """One system over all its cells.

    Attributes
    ----------
    label : str
        Of the system.
    metrics : mapping of str to list of mapping
        `metrics.json` of every cell that ran, by recording.
    reasons : tuple of str
        Why others did not.
    """

    label: str
    metrics: Mapping[str, Sequence[Document]]
    reasons: tuple[str, ...]

    def mean(self, name: str) -> float | None:
        """Mean over the recordings of the mean over their runs; None where there is none."""
        means = []
        for runs in self.metrics.values():
            known = [run[name] for run in runs if run[name] is not None]
            if known:
                means.append(statistics.fmean(known))
        return statistics.fmean(means) if means else None

    @property
    def runs(self) -> list[Document]:
        """All that ran."""
        return [run for runs in self.metrics.values() for run in runs]

    def recovered(self) -> tuple[int, int]:
        """Total occlusions recovered from, and judged."""
        judged = [r for run in self.runs for r in run["recovered"] if r is not None]
        return sum(judged), len(judged)


def summarise(plan: Plan, folder: Path) -> list[SystemSummary]:
    """Read the cells of the grid, and put them together by system."""
    cells = [cell for cell in plan.cells() if not cell.start.kind]
    return [
        _summary(system.label, [cell for cell in cells if cell.system == system], folder)
        for system in plan.systems
    ]


def _summary(label: str, cells: Sequence[GridCell], folder: Path) -> SystemSummary:
    metrics: dict[str, list[Document]] = {}
    reasons = []
    for cell in cells:
        path = cell.folder(folder)
        if (path / METRICS).is_file():
            metrics.setdefault(cell.source.name, []).append(read_document(path / METRICS))
        elif (path / FAILED).is_file():
            reasons.append(str(read_document(path / FAILED).get("reason")))
    return SystemSummary(label, metrics, tuple(reasons))


def table(summaries: Sequence[SystemSummary]) -> Table:
    """For a terminal: means over seeds and then recordings, the best success AUC first."""
    columns: dict[str, Callable[[SystemSummary], str]] = {
        "RMSE, px": lambda s: _number(s.mean("rmse_px"), 1),
        "median error, px": lambda s: _number(s.mean("median_px"), 1),
        "on target while visible": lambda s: _number(s.mean("on_target"), 3),
        "success AUC": lambda s: _number(s.mean("success_auc"), 3),
        "recovered": lambda s: "{} of {}".format(*s.recovered()),
        "failures": lambda s: _number(s.mean("failures"), 1),
        "runs": lambda s: str(len(s.runs)) + (f" ({len(s.reasons)} failed)" * bool(s.reasons)),
    }
    made = Table("")
    for name in columns:
        made.add_column(Text(name), justify="right")
    order = sorted(summaries, key=lambda s: -(s.mean("success_auc") or 0.0))
    for summary in order:
        made.add_row(Text(summary.label), *(Text(cell(summary)) for cell in columns.values()))
    return made


def _number(value: float | None, decimals: int) -> str:
    return "-" if value is None else f"{value:.{decimals}f}"
