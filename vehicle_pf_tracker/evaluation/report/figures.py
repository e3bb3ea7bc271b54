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

"""Figures of a report: success and precision, intervals, errors over time.

They are drawn with the colours, letters and widths of a `Look`: for a page or for a paper.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import safe_name
from vehicle_pf_tracker.evaluation.occlusions import CLOSE_PX
from vehicle_pf_tracker.evaluation.plots import STYLES, stretches
from vehicle_pf_tracker.evaluation.report.aggregates import RANKED, Aggregates
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun


@dataclass(frozen=True, slots=True)
class Look:
    """Colours and letters that figures are drawn with.

    Attributes
    ----------
    colours : mapping of str to str
        Colours by name, such as ``ink``, ``accent`` and ``s0`` for the first style of a line.
    letters : float
        Size of the letters, points.
    svg_letters : str
        ``none`` leaves the letters of an SVG to the reader's fonts, ``path`` draws them.
    columns : (float, float)
        Widths of a figure and of a row of panels, inches.
    """

    colours: Mapping[str, str]
    letters: float
    svg_letters: str
    columns: tuple[float, float]

    def __getitem__(self, name: str) -> str:
        """Return the colour `name`."""
        return self.colours[name]

    @property
    def settings(self) -> Any:
        """Settings to make figures under; see `matplotlib.rc_context`."""
        return {
            "svg.fonttype": self.svg_letters,
            "svg.hashsalt": "vehicle_pf_tracker",
            "pdf.fonttype": 42,  # journals refuse matplotlib's usual Type 3
            "font.size": self.letters,
            "axes.edgecolor": self["rule"],
            "axes.labelcolor": self["muted"],
            "axes.linewidth": 0.8,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "text.color": self["ink"],
            "xtick.color": self["rule"],
            "ytick.color": self["rule"],
            "xtick.labelcolor": self["muted"],
            "ytick.labelcolor": self["muted"],
            "grid.color": self["rule"],
            "grid.linewidth": 0.5,
        }


_INK: Mapping[str, str] = MappingProxyType(
    {
        "ink": "#010101",
        "muted": "#020202",
        "rule": "#030303",
        "total": "#040404",
        "partial": "#050505",
        "accent": "#060606",
        **{f"s{slot}": f"#0a0a{slot:02x}" for slot in range(6)},
    }
)
"""Stand-ins for the page's colours: what is drawn in one of them is drawn in ``var(--name)``."""


PAGE = Look(_INK, 8.0, "none", (3.9, 10.2))
"""Figures of the page, which are recoloured by its scheme."""


PAPER = Look(
    MappingProxyType(
        {
            "ink": "#000000",
            "muted": "#404040",
            "rule": "#b0b0b0",
            "total": "#c9ced4",
            "partial": "#e9ecef",
            "accent": "#0a5c9e",
            **{f"s{slot}": style.colour for slot, style in enumerate(STYLES)},
        }
    ),
    8.0,  # as large as captions; the smallest that IEEE advises is 8
    "path",
    (3.5, 7.16),  # a column and the page in IEEE's two-column layout
)
"""Dark letters on white, drawn as paths in SVG so that they are the same in every program."""


CURVES = {
    "success": ("Success", "overlap threshold", "share of frames above"),
    "precision": ("Precision", "error threshold, px", "share of frames below"),
    "normalised": ("Normalised precision", "error threshold, box sizes", "share of frames below"),
}
"""Title and names of the axes of each curve."""
ERRORS = "errors_"
"""Beginning of the names of figures of errors over time; the recording follows."""
LEAST_ERROR = 0.5
"""Errors below this, in px, are drawn at the foot of the logarithmic scale."""
_ROW = 0.19
"""Height of a system's row in a figure of intervals, inches."""
_PANEL_HEIGHT = 1.35
"""Height of a panel of errors over time, inches: three in a row are then about 5 to 3."""
_PANELS_IN_A_ROW = 3


class Drawn(NamedTuple):
    """A figure, its caption, and the words that it is read out with."""

    figure: Figure
    caption: str
    spoken: str


def draw_all(
    evaluation: ScoredEvaluation, aggregates: Aggregates, slots: Mapping[str, int], look: Look
) -> dict[str, Drawn]:
    """Draw every figure of an evaluation that there are numbers for, by name.

    Systems in `slots` have the style of this number.
    """
    with rc_context(look.settings):
        found = {"intervals": _intervals(aggregates, look)}
        for name in CURVES:
            lines = curve_lines(evaluation, aggregates.order, slots, name)
            found[name] = _curves(name, lines, look)
        for entry in evaluation.recordings:
            runs = evaluation.by_system(entry.name, aggregates.order)
            series = error_series(runs, evaluation.truths[entry.name])
            found[ERRORS + safe_name(entry.name)] = _errors(series, look)
    return {name: drawn for name, drawn in found.items() if drawn is not None}


class CurveLine(NamedTuple):
    """A line: its label, the number of its style (None is drawn grey), and its points."""

    label: str
    slot: int | None
    xs: Array
    ys: Array


def curve_lines(
    evaluation: ScoredEvaluation, order: Sequence[str], slots: Mapping[str, int], name: str
) -> list[CurveLine]:
    """Return a curve of `CURVES`: means over the seeds of a recording, then over recordings."""
    lines = []
    for label in order:
        curves = [
            [run.curves[name] for run in evaluation.of(entry.name, label) if name in run.curves]
            for entry in evaluation.recordings
        ]
        means = [np.mean([curve.shares for curve in some], axis=0) for some in curves if some]
        if means:
            thresholds = next(curve.thresholds for some in curves for curve in some)
            lines.append(CurveLine(label, slots.get(label), thresholds, np.mean(means, axis=0)))
    return lines


def draw_curves(axes: Axes, lines: Sequence[CurveLine], look: Look) -> None:
    """Draw shares over their thresholds, the first of those with a style on top."""
    for line in reversed(lines):
        if line.slot is None:
            axes.plot(line.xs, line.ys, color=look["muted"], lw=0.7, alpha=0.55)
            continue
        dashes, colour = STYLES[line.slot].line, look[f"s{line.slot}"]
        axes.plot(line.xs, line.ys, color=colour, linestyle=dashes, lw=1.7, label=line.label)
    axes.set(ylim=(0, 1), xlim=(float(lines[0].xs[0]), float(lines[0].xs[-1])))
    axes.grid(axis="y", alpha=0.6)
    axes.set_axisbelow(True)


def _curves(name: str, lines: Sequence[CurveLine], look: Look) -> Drawn | None:
    """Draw curves with a legend of the systems that have a style."""
    if not lines:
        return None
    title, xlabel, ylabel = CURVES[name]
    rows = -(-sum(line.slot is not None for line in lines) // 2)
    figure = Figure(figsize=(look.columns[0], 2.2 + 0.16 * rows), layout="constrained")
    axes = figure.add_subplot(xlabel=xlabel, ylabel=ylabel)
    draw_curves(axes, lines, look)
    handles, labels = axes.get_legend_handles_labels()  # drawn last to first
    figure.legend(
        handles[::-1], labels[::-1], loc="outside lower center", ncols=2, frameon=False,
        handlelength=2.8,
    )  # fmt: skip
    areas = ", ".join(f"{line.label} {line.ys.mean():.3f}" for line in lines)
    return Drawn(figure, title, f"{title}; areas: {areas}")


def _intervals(aggregates: Aggregates, look: Look) -> Drawn | None:
    """Draw the first ranked metric of all systems, with intervals.

    Small dots are the means on the recordings.
    """
    column = RANKED[0]
    overall = {label: aggregates.overall[label].get(column.key) for label in aggregates.order}
    rows = {label: summary for label, summary in overall.items() if summary is not None}
    if not rows:
        return None
    figure = Figure(figsize=(look.columns[0], 0.55 + _ROW * len(rows)), layout="constrained")
    axes = figure.add_subplot(xlabel=column.title, ylim=(len(rows) - 0.4, -0.6))
    for position, (label, whole) in enumerate(rows.items()):
        known = [
            summary.mean
            for (_, system), found in aggregates.by_recording.items()
            if system == label and (summary := found.get(column.key)) is not None
        ]
        heights = [position] * len(known)
        axes.plot(known, heights, ".", color=look["muted"], ms=4, alpha=0.8, mew=0)
        if whole.low is not None and whole.high is not None:
            axes.hlines(position, whole.low, whole.high, color=look["accent"], lw=2.2)
        axes.plot([whole.mean], [position], "D", color=look["accent"], ms=4.2)
    axes.set_yticks(range(len(rows)), list(rows))
    axes.tick_params(axis="y", length=0, labelcolor=look["ink"])
    axes.grid(axis="x", alpha=0.6)
    axes.spines["left"].set_visible(False)
    axes.set_axisbelow(True)
    words = ", ".join(f"{label} {found.mean:.{column.decimals}f}" for label, found in rows.items())
    caption = f"{column.label}: mean, 95 % interval, and each recording"
    return Drawn(figure, caption, f"{column.label}: {words}")


@dataclass(frozen=True, slots=True)
class ErrorSeries:
    """Errors over time on one recording.

    Attributes
    ----------
    errors : mapping of str to (S, N) array
        Errors in px by seed and frame, by system; NaN where nothing is scored.
    spans : mapping of str to sequence of (int, int)
        First and last frames of the occlusions, by ``partial`` and ``total``.
    highest : float
        Largest error of any system, px, so that panels share their scale.
    """

    errors: Mapping[str, Array]
    spans: Mapping[str, Sequence[tuple[int, int]]]
    highest: float


def error_series(
    runs: Mapping[str, Sequence[ScoredRun]], truths: Mapping[int, Truth]
) -> ErrorSeries:
    """Return the errors of the systems that have any."""
    errors = {
        label: np.stack(scored)
        for label, some in runs.items()
        if (scored := [run.errors for run in some if np.isfinite(run.errors).any()])
    }
    spans = {
        "partial": stretches(truths, {Occlusion.PARTIAL}),
        "total": stretches(truths, {Occlusion.TOTAL}),
    }
    highest = max((float(np.nanmax(table)) for table in errors.values()), default=0.0)
    return ErrorSeries(errors, spans, highest)


def draw_errors(axes: Axes, series: ErrorSeries, label: str, look: Look) -> None:
    """Draw the error of a system over time: the median and the range over the seeds."""
    table = np.maximum(series.errors[label], LEAST_ERROR)
    frames = np.arange(1, table.shape[1] + 1)
    for name, spans in series.spans.items():
        for first, last in spans:
            axes.axvspan(first - 0.5, last + 0.5, color=look[name], lw=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # frames without truth have no median
        low, high = np.nanmin(table, axis=0), np.nanmax(table, axis=0)
        middle = np.nanmedian(table, axis=0)
    axes.fill_between(frames, low, high, color=look["accent"], alpha=0.25, lw=0)
    axes.plot(frames, middle, color=look["accent"], lw=1.2)
    axes.axhline(CLOSE_PX, color=look["muted"], lw=0.7, ls=(0, (1, 2)))
    axes.set(yscale="log", ylim=(LEAST_ERROR, max(series.highest * 1.3, 100.0)))
    axes.set(xlim=(1, max(len(frames), 2)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.minorticks_off()


def _errors(series: ErrorSeries, look: Look) -> Drawn | None:
    """Draw the errors over time, a panel for each system, on shared axes."""
    count = len(series.errors)
    if not count:
        return None
    columns = min(count, _PANELS_IN_A_ROW)
    rows = -(-count // columns)
    size = look.columns[columns > 1], 0.3 + _PANEL_HEIGHT * rows
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, label in zip(grid.flat, series.errors, strict=False):
        draw_errors(axes, series, label, look)
        axes.set_title(label, fontsize=look.letters, loc="left", pad=2.0)
    for axes in list(grid.flat)[count:]:
        axes.remove()
    for axes in list(grid.flat)[count - columns : count]:
        axes.tick_params(labelbottom=True)
    figure.supxlabel("frame", fontsize=look.letters, color=look["muted"])
    figure.supylabel("error, px", fontsize=look.letters, color=look["muted"])
    medians = (f"{label} {np.nanmedian(table):.1f} px" for label, table in series.errors.items())
    return Drawn(figure, "Error over time", f"Error over time; medians: {', '.join(medians)}")
