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

"""The figures of a report as files, sized for a paper of two columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from vehicle_pf_tracker.evaluation.evaluation_folder import safe_name
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.figures import (
    CURVES,
    PAPER,
    CurveLine,
    ErrorSeries,
    curve_lines,
    draw_curves,
    draw_errors,
    error_series,
    intervals_figure,
)
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation
from vehicle_pf_tracker.offline.output_files import make_folder, replacing

FORMATS = ("pdf", "svg", "png")
FIGURES = "figures"

ONE_COLUMN, TWO_COLUMNS = 3.5, 7.16
"""Widths of a column and of the page in IEEE's two-column layout, inches."""
_DPI = 300
"""Resolution of PNG files, which IEEE asks of colour pictures."""
_PANEL_HEIGHT = 1.35
"""Height of a panel of errors over time, inches: three in a row are then about 5 to 3."""
_PANELS_IN_A_ROW = 3

_METADATA: Mapping[str, dict[str, Any]] = MappingProxyType(
    {
        "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
        "svg": {"Date": None, "Creator": None},
        "png": {"Software": None},
    }
)
"""No date and no version, so that the same folder gives the same files."""


def write_figures(
    evaluation: ScoredEvaluation,
    aggregates: Aggregates,
    slots: Mapping[str, int],
    formats: Sequence[str],
) -> list[Path]:
    """Write every figure of the page to ``figures/``, in each of the formats.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    folder = make_folder(evaluation.folder.path / FIGURES)
    written = []
    for name, figure in _figures(evaluation, aggregates, slots).items():
        with rc_context(PAPER.settings):
            # Laid out once: each drawing moves a constrained layout a little further.
            figure.draw_without_rendering()
            figure.set_layout_engine("none")
        for kind in formats:
            path = folder / f"{name}.{kind}"
            with replacing(path) as partial, rc_context(PAPER.settings):
                figure.savefig(partial, format=kind, dpi=_DPI, metadata=_METADATA[kind])
            written.append(path)
    return written


def _figures(
    evaluation: ScoredEvaluation, aggregates: Aggregates, slots: Mapping[str, int]
) -> dict[str, Figure]:
    figures = {}
    if intervals := intervals_figure(aggregates, PAPER, ONE_COLUMN):
        figures["intervals"] = intervals
    for name, (_, xlabel, ylabel) in CURVES.items():
        if lines := curve_lines(evaluation, aggregates.order, slots, name):
            figures[name] = _curves(lines, xlabel, ylabel)
    for entry in evaluation.recordings:
        runs = evaluation.by_system(entry.name, aggregates.order)
        series = error_series(runs, evaluation.truths[entry.name])
        if series.errors:
            figures[f"errors_{safe_name(entry.name)}"] = _errors(series)
    return figures


def _curves(lines: Sequence[CurveLine], xlabel: str, ylabel: str) -> Figure:
    """Draw curves with a legend of the systems that have a style."""
    with rc_context(PAPER.settings):
        styled = sum(line.slot is not None for line in lines)
        rows = -(-styled // 2)
        figure = Figure(figsize=(ONE_COLUMN, 2.2 + 0.16 * rows), layout="constrained")
        axes = figure.add_subplot(xlabel=xlabel, ylabel=ylabel)
        draw_curves(axes, lines, PAPER)
        handles, labels = axes.get_legend_handles_labels()  # drawn last to first
        figure.legend(
            handles[::-1], labels[::-1], loc="outside lower center", ncols=2, frameon=False,
            handlelength=2.8,
        )  # fmt: skip
    return figure


def _errors(series: ErrorSeries) -> Figure:
    """Draw the errors over time, a panel for each system, on shared axes."""
    count = len(series.errors)
    columns = min(count, _PANELS_IN_A_ROW)
    rows = -(-count // columns)
    width = ONE_COLUMN if columns == 1 else TWO_COLUMNS
    with rc_context(PAPER.settings):
        figure = Figure(figsize=(width, 0.3 + _PANEL_HEIGHT * rows), layout="constrained")
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for axes, label in zip(grid.flat, series.errors, strict=False):
            draw_errors(axes, series, label, PAPER)
            axes.set_title(label, fontsize=PAPER.letters, loc="left", pad=2.0)
        for axes in list(grid.flat)[count:]:
            axes.remove()
        for axes in list(grid.flat)[count - columns : count]:
            axes.tick_params(labelbottom=True)
        figure.supxlabel("frame", fontsize=PAPER.letters, color=PAPER["muted"])
        figure.supylabel("error, px", fontsize=PAPER.letters, color=PAPER["muted"])
    return figure
