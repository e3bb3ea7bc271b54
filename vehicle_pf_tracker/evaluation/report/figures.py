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

"""The small figures of a report: errors over time, curves, robustness.

Colours and letters of figures, for a page and for a paper.

Figures as SVG that stands in a page and takes its colours from the page's scheme.
"""

from __future__ import annotations

import html
import io
import itertools
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.occlusions import CLOSE_PX
from vehicle_pf_tracker.evaluation.plots import STYLES
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.columns import RANKED
from vehicle_pf_tracker.evaluation.report.figure_data import (
    CURVES,
    CurveLine,
    Interval,
    Spans,
    curve_lines,
    error_series,
    interval_rows,
)
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
    """

    colours: Mapping[str, str]
    letters: float
    svg_letters: str

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


PAGE = Look(_INK, 8.0, "none")
"""Figures of the page, which are recoloured by its scheme."""


class SvgMaker:
    """Turns figures into SVG elements that can stand in one page: no two share an id."""

    def __init__(self) -> None:
        self._numbers = itertools.count(1)

    def make(self, figure: Figure, label: str) -> str:
        """Return `figure` as an SVG element that is read out as `label`."""
        text = io.StringIO()
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        with rc_context(PAGE.settings):
            figure.savefig(text, format="svg", transparent=True, metadata=nothing)
        element = text.getvalue()
        element = element[element.index("<svg") :]
        element = re.sub(r"<metadata>.*?</metadata>\s*", "", element, flags=re.DOTALL)
        element = re.sub(r"<!--.*?-->\s*", "", element, flags=re.DOTALL)
        prefix = f"f{next(self._numbers)}-"
        for before in (' id="', 'href="#', "url(#"):
            element = element.replace(before, before + prefix)
        for name, colour in _INK.items():
            element = element.replace(colour, f"var(--{name})")
        size = re.search(r'viewBox="[^"]*"', element)
        assert size is not None
        head = f'<svg {size[0]} role="img" aria-label="{html.escape(label)}"'
        head += ' xmlns:xlink="http://www.w3.org/1999/xlink"'
        return re.sub(r"^<svg[^>]*", head, element).replace("\n", " ").replace("  ", " ")


LEAST_ERROR = 0.5
"""Errors below this, in px, are drawn at the foot of the logarithmic scale."""
_SMALL, _CURVE = (3.3, 1.75), (3.6, 2.6)
_PLACE = (0.16, 0.235, 0.825, 0.74)
"""Axes of a small figure: left, bottom, width and height, as shares of it."""
_INTERVALS = 4.4
_ROW = 0.19
"""Height of a system's row in a figure of intervals, in inches."""


def error_panel(errors: Sequence[Array], spans: Spans, highest: float) -> Figure:
    """Draw the error over time of one system on one recording; see `draw_errors`."""
    with rc_context(PAGE.settings):
        figure = Figure(figsize=_SMALL)
        axes = figure.add_axes(_PLACE)  # laying out takes longer than drawing, for each system
        draw_errors(axes, errors, spans, highest, PAGE)
        axes.set(xlabel="frame", ylabel="error, px")
    return figure


def draw_errors(
    axes: Axes, errors: Sequence[Array], spans: Spans, highest: float, look: Look
) -> None:
    """Draw the error over time: the median and the range over the seeds.

    Parameters
    ----------
    axes : Axes
        Drawn into; its labels are left to the caller.
    errors : sequence of (N,) array
        Error in px by frame, one for each seed; NaN where nothing is scored.
    spans : Spans
        The occlusions, which are shaded.
    highest : float
        Largest error of any system on this recording, in px, so that panels share their scale.
    look : Look
        Colours.
    """
    table = np.maximum(np.stack(list(errors)), LEAST_ERROR)
    frames = np.arange(1, table.shape[1] + 1)
    _shade(axes, spans, look)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # frames without truth have no median
        low, high = np.nanmin(table, axis=0), np.nanmax(table, axis=0)
        middle = np.nanmedian(table, axis=0)
    axes.fill_between(frames, low, high, color=look["accent"], alpha=0.25, lw=0)
    axes.plot(frames, middle, color=look["accent"], lw=1.2)
    axes.axhline(CLOSE_PX, color=look["muted"], lw=0.7, ls=(0, (1, 2)))
    axes.set(yscale="log", ylim=(LEAST_ERROR, max(highest * 1.3, 100.0)))
    axes.set(xlim=(1, max(len(frames), 2)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.minorticks_off()


def curve_panel(lines: Sequence[CurveLine], xlabel: str, ylabel: str) -> Figure:
    """Draw shares over their thresholds."""
    with rc_context(PAGE.settings):
        figure = Figure(figsize=_CURVE, layout="constrained")
        draw_curves(figure.add_subplot(), lines, PAGE)
        figure.axes[0].set(xlabel=xlabel, ylabel=ylabel)
    return figure


def draw_curves(axes: Axes, lines: Sequence[CurveLine], look: Look) -> None:
    """Draw shares over their thresholds, without the names of the axes."""
    draw_lines(axes, lines, look)
    axes.set(ylim=(0, 1), xlim=(float(lines[0].xs[0]), float(lines[0].xs[-1])))
    axes.grid(axis="y", alpha=0.6)
    axes.set_axisbelow(True)


def intervals_panel(
    rows: Sequence[Interval], xlabel: str, look: Look = PAGE, width: float = _INTERVALS
) -> Figure:
    """Draw means with their intervals, and what they are means of as small dots."""
    with rc_context(look.settings):
        figure = Figure(figsize=(width, 0.55 + _ROW * len(rows)), layout="constrained")
        axes = figure.add_subplot()
        for position, row in enumerate(rows):
            heights = [position] * len(row.values)
            axes.plot(row.values, heights, ".", color=look["muted"], ms=4, alpha=0.8, mew=0)
            if row.low is not None and row.high is not None:
                axes.plot([row.low, row.high], [position, position], color=look["accent"], lw=2.2)
            axes.plot([row.mean], [position], "D", color=look["accent"], ms=4.2)
        axes.set_yticks(range(len(rows)), [row.label for row in rows])
        axes.set(ylim=(len(rows) - 0.4, -0.6), xlabel=xlabel)
        axes.tick_params(axis="y", length=0, labelcolor=look["ink"])
        axes.grid(axis="x", alpha=0.6)
        axes.spines["left"].set_visible(False)
        axes.set_axisbelow(True)
    return figure


def draw_lines(axes: Axes, lines: Sequence[CurveLine], look: Look) -> None:
    """Draw lines, the first of those with a style on top."""
    for line in reversed(lines):
        if line.slot is None:
            axes.plot(line.xs, line.ys, color=look["muted"], lw=0.7, alpha=0.55)
            continue
        dashes = STYLES[line.slot].line
        colour = look[f"s{line.slot}"]
        axes.plot(line.xs, line.ys, color=colour, linestyle=dashes, lw=1.7, label=line.label)


def _shade(axes: Axes, spans: Spans, look: Look) -> None:
    for name, stretches in spans.items():
        for first, last in stretches:
            axes.axvspan(first - 0.5, last + 0.5, color=look[name], lw=0)


@dataclass(frozen=True, slots=True)
class Panel:
    """An SVG element and the words under it."""

    svg: str
    caption: str


def curve_panels(
    evaluation: ScoredEvaluation,
    order: Sequence[str],
    slots: Mapping[str, int],
    maker: SvgMaker,
) -> list[Panel]:
    """Draw the three curves: means over the seeds of a recording, and then over recordings."""
    panels = []
    for name, (title, xlabel, ylabel) in CURVES.items():
        lines = curve_lines(evaluation, order, slots, name)
        if lines:
            areas = ", ".join(f"{line.label} {line.ys.mean():.3f}" for line in lines)
            svg = maker.make(curve_panel(lines, xlabel, ylabel), f"{title}; areas: {areas}")
            panels.append(Panel(svg, title))
    return panels


def main_panel(aggregates: Aggregates, maker: SvgMaker) -> Panel | None:
    """Draw the first ranked metric of all systems, with intervals; None without any."""
    column, rows = RANKED[0], interval_rows(aggregates)
    if not rows:
        return None
    words = ", ".join(f"{row.label} {row.mean:.{column.decimals}f}" for row in rows)
    svg = maker.make(intervals_panel(rows, column.title), f"{column.label}: {words}")
    return Panel(svg, f"{column.label}: mean, 95 % interval, and each recording")


def error_panels(
    runs: Mapping[str, Sequence[ScoredRun]], truths: Mapping[int, Truth], maker: SvgMaker
) -> list[Panel]:
    """Draw the error over time on one recording, one panel for each system."""
    series = error_series(runs, truths)
    panels = []
    for label, errors in series.errors.items():
        median = float(np.nanmedian(np.concatenate(list(errors))))
        figure = error_panel(errors, series.spans, series.highest)
        svg = maker.make(figure, f"Error of {label} over time; median {median:.1f} px")
        panels.append(Panel(svg, label))
    return panels
