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

"""The small figures of a report: errors over time, curves, robustness."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.occlusions import CLOSE_PX
from vehicle_pf_tracker.evaluation.plots import STYLES
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.columns import RANKED
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun
from vehicle_pf_tracker.evaluation.report.svg import STYLE, SvgMaker, ink

Spans = Mapping[str, Sequence[tuple[int, int]]]
"""First and last frames of the stretches with an occlusion, by ``partial`` and ``total``."""

LEAST_ERROR = 0.5
"""Errors below this, in px, are drawn at the foot of the logarithmic scale."""
_SMALL, _CURVE = (3.3, 1.75), (3.6, 2.6)
_PLACE = (0.16, 0.235, 0.825, 0.74)
"""Axes of a small figure: left, bottom, width and height, as shares of it."""
_ROW = 0.19
"""Height of a system's row in a figure of intervals, in inches."""


@dataclass(frozen=True, slots=True)
class CurveLine:
    """A line of a figure.

    Attributes
    ----------
    label : str
        Label of the line.
    slot : int or None
        Number of its style in `STYLES`; None is drawn grey, behind the others.
    xs, ys : (N,) array
        Points of the line.
    """

    label: str
    slot: int | None
    xs: Array
    ys: Array


def error_panel(errors: Sequence[Array], spans: Spans, highest: float) -> Figure:
    """Draw the error over time of one system on one recording.

    Parameters
    ----------
    errors : sequence of (N,) array
        Error in px by frame, one for each seed; NaN where nothing is scored.
    spans : Spans
        The occlusions, which are shaded.
    highest : float
        Largest error of any system on this recording, in px, so that panels share their scale.
    """
    table = np.maximum(np.stack(list(errors)), LEAST_ERROR)
    frames = np.arange(1, table.shape[1] + 1)
    with rc_context(STYLE), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # frames without truth have no median
        figure = Figure(figsize=_SMALL)
        axes = figure.add_axes(_PLACE)  # laying out takes longer than drawing, for each system
        _shade(axes, spans)
        low, high = np.nanmin(table, axis=0), np.nanmax(table, axis=0)
        axes.fill_between(frames, low, high, color=ink("accent"), alpha=0.25, lw=0)
        axes.plot(frames, np.nanmedian(table, axis=0), color=ink("accent"), lw=1.2)
        axes.axhline(CLOSE_PX, color=ink("muted"), lw=0.7, ls=(0, (1, 2)))
        axes.set(yscale="log", ylim=(LEAST_ERROR, max(highest * 1.3, 100.0)), ylabel="error, px")
        axes.set(xlim=(1, max(len(frames), 2)), xlabel="frame")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.minorticks_off()
    return figure


def curve_panel(lines: Sequence[CurveLine], xlabel: str, ylabel: str) -> Figure:
    """Draw shares over their thresholds."""
    with rc_context(STYLE):
        figure = Figure(figsize=_CURVE, layout="constrained")
        axes = figure.add_subplot()
        draw_lines(axes, lines)
        axes.set(xlabel=xlabel, ylabel=ylabel, ylim=(0, 1))
        axes.set_xlim(float(lines[0].xs[0]), float(lines[0].xs[-1]))
        axes.grid(axis="y", alpha=0.6)
        axes.set_axisbelow(True)
    return figure


@dataclass(frozen=True, slots=True)
class Interval:
    """A row of a figure of intervals.

    Attributes
    ----------
    label : str
        Label of the system.
    values : sequence of float
        Means on the recordings.
    mean : float
        Mean over the recordings.
    low, high : float or None
        Interval of the mean; None where there is none.
    """

    label: str
    values: Sequence[float]
    mean: float
    low: float | None
    high: float | None


def intervals_panel(rows: Sequence[Interval], xlabel: str) -> Figure:
    """Draw means with their intervals, and what they are means of as small dots."""
    with rc_context(STYLE):
        figure = Figure(figsize=(4.4, 0.55 + _ROW * len(rows)), layout="constrained")
        axes = figure.add_subplot()
        for position, row in enumerate(rows):
            heights = [position] * len(row.values)
            axes.plot(row.values, heights, ".", color=ink("muted"), ms=4, alpha=0.8, mew=0)
            if row.low is not None and row.high is not None:
                axes.plot([row.low, row.high], [position, position], color=ink("accent"), lw=2.2)
            axes.plot([row.mean], [position], "D", color=ink("accent"), ms=4.2)
        axes.set_yticks(range(len(rows)), [row.label for row in rows])
        axes.set(ylim=(len(rows) - 0.4, -0.6), xlabel=xlabel)
        axes.tick_params(axis="y", length=0, labelcolor=ink("ink"))
        axes.grid(axis="x", alpha=0.6)
        axes.spines["left"].set_visible(False)
        axes.set_axisbelow(True)
    return figure


def draw_lines(axes: Axes, lines: Sequence[CurveLine]) -> None:
    """Draw lines, the first of those with a style on top."""
    for line in reversed(lines):
        if line.slot is None:
            axes.plot(line.xs, line.ys, color=ink("muted"), lw=0.7, alpha=0.55)
            continue
        dashes = STYLES[line.slot].line
        axes.plot(line.xs, line.ys, color=ink(f"s{line.slot}"), linestyle=dashes, lw=1.7)


def _shade(axes: Axes, spans: Spans) -> None:
    for name, stretches in spans.items():
        for first, last in stretches:
            axes.axvspan(first - 0.5, last + 0.5, color=ink(name), lw=0)


@dataclass(frozen=True, slots=True)
class Panel:
    """An SVG element and the words under it."""

    svg: str
    caption: str


_CURVES = {
    "success": ("Success", "overlap threshold", "share of frames above"),
    "precision": ("Precision", "error threshold, px", "share of frames below"),
    "normalised": ("Normalised precision", "error threshold, box sizes", "share of frames below"),
}


def curve_panels(
    evaluation: ScoredEvaluation,
    order: Sequence[str],
    slots: Mapping[str, int],
    maker: SvgMaker,
) -> list[Panel]:
    """Draw the three curves: means over the seeds of a recording, and then over recordings."""
    panels = []
    for name, (title, xlabel, ylabel) in _CURVES.items():
        lines = [
            line
            for label in order
            if (line := _curve(evaluation, label, name, slots.get(label))) is not None
        ]
        if lines:
            areas = ", ".join(f"{line.label} {line.ys.mean():.3f}" for line in lines)
            svg = maker.make(curve_panel(lines, xlabel, ylabel), f"{title}; areas: {areas}")
            panels.append(Panel(svg, title))
    return panels


def main_panel(aggregates: Aggregates, maker: SvgMaker) -> Panel | None:
    """Draw the first ranked metric of all systems, with intervals; None without any."""
    column = RANKED[0]
    rows = []
    for label in aggregates.order:
        whole = aggregates.overall[label].get(column.key)
        if whole is None:
            continue
        known = [
            summary.mean
            for (_, system), found in aggregates.by_recording.items()
            if system == label and (summary := found.get(column.key)) is not None
        ]
        rows.append(Interval(label, known, whole.mean, whole.low, whole.high))
    if not rows:
        return None
    words = ", ".join(f"{row.label} {row.mean:.{column.decimals}f}" for row in rows)
    svg = maker.make(intervals_panel(rows, column.title), f"{column.label}: {words}")
    return Panel(svg, f"{column.label}: mean, 95 % interval, and each recording")


def error_panels(
    runs: Mapping[str, Sequence[ScoredRun]], truths: Mapping[int, Truth], maker: SvgMaker
) -> list[Panel]:
    """Draw the error over time on one recording, one panel for each system."""
    spans = {
        "partial": stretches(truths, Occlusion.PARTIAL),
        "total": stretches(truths, Occlusion.TOTAL),
    }
    found = {
        label: [run.errors for run in some if np.isfinite(run.errors).any()]
        for label, some in runs.items()
    }
    found = {label: errors for label, errors in found.items() if errors}
    highest = max((float(np.nanmax(e)) for errors in found.values() for e in errors), default=0)
    panels = []
    for label, errors in found.items():
        median = float(np.nanmedian(np.concatenate(errors)))
        figure = error_panel(_same_length(errors), spans, highest)
        svg = maker.make(figure, f"Error of {label} over time; median {median:.1f} px")
        panels.append(Panel(svg, label))
    return panels


def stretches(truths: Mapping[int, Truth], occlusion: Occlusion) -> list[tuple[int, int]]:
    """Return the first and last frames of the stretches with this occlusion."""
    found = []
    grouped = itertools.groupby(sorted(truths), lambda n: truths[n].occlusion is occlusion)
    for matches, group in grouped:
        numbers = list(group)
        if matches:
            found.append((numbers[0], numbers[-1]))
    return found


def _curve(
    evaluation: ScoredEvaluation, label: str, name: str, slot: int | None
) -> CurveLine | None:
    by_recording: dict[str, list[Array]] = {}
    thresholds: Array | None = None
    for run in evaluation.of(system=label):
        if name in run.curves:
            by_recording.setdefault(run.recording, []).append(run.curves[name].shares)
            thresholds = run.curves[name].thresholds
    if thresholds is None:
        return None
    means = [np.mean(shares, axis=0) for shares in by_recording.values()]
    return CurveLine(label, slot, thresholds, np.mean(means, axis=0))


def _same_length(errors: Sequence[Array]) -> list[Array]:
    longest = max(map(len, errors))
    return [np.pad(e, (0, longest - len(e)), constant_values=np.nan) for e in errors]
