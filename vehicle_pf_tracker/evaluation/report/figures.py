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

They are drawn with the colours and letters of a `Look`: for a page or for a paper. `SvgMaker` makes
them stand in a page and take their colours from the page's scheme.
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
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.occlusions import CLOSE_PX
from vehicle_pf_tracker.evaluation.plots import STYLES, stretches
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.columns import RANKED
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
)
"""Dark letters on white, drawn as paths in SVG so that they are the same in every program."""


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


CURVES = {
    "success": ("Success", "overlap threshold", "share of frames above"),
    "precision": ("Precision", "error threshold, px", "share of frames below"),
    "normalised": ("Normalised precision", "error threshold, box sizes", "share of frames below"),
}
"""Title and names of the axes of each curve."""
LEAST_ERROR = 0.5
"""Errors below this, in px, are drawn at the foot of the logarithmic scale."""
_SMALL, _CURVE = (3.3, 1.75), (3.6, 2.6)
_PLACE = (0.16, 0.235, 0.825, 0.74)
"""Axes of a small figure: left, bottom, width and height, as shares of it."""
_INTERVALS = 4.4
_ROW = 0.19
"""Height of a system's row in a figure of intervals, in inches."""


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


def intervals_figure(
    aggregates: Aggregates, look: Look, width: float = _INTERVALS
) -> Figure | None:
    """Draw the first ranked metric of all systems, with intervals; None without any.

    Small dots are the means on the recordings.
    """
    key, title = RANKED[0].key, RANKED[0].title
    overall = {label: aggregates.overall[label].get(key) for label in aggregates.order}
    rows = {label: summary for label, summary in overall.items() if summary is not None}
    if not rows:
        return None
    with rc_context(look.settings):
        figure = Figure(figsize=(width, 0.55 + _ROW * len(rows)), layout="constrained")
        axes = figure.add_subplot()
        for position, (label, whole) in enumerate(rows.items()):
            known = [
                summary.mean
                for (_, system), found in aggregates.by_recording.items()
                if system == label and (summary := found.get(key)) is not None
            ]
            heights = [position] * len(known)
            axes.plot(known, heights, ".", color=look["muted"], ms=4, alpha=0.8, mew=0)
            if whole.low is not None and whole.high is not None:
                axes.hlines(position, whole.low, whole.high, color=look["accent"], lw=2.2)
            axes.plot([whole.mean], [position], "D", color=look["accent"], ms=4.2)
        axes.set_yticks(range(len(rows)), list(rows))
        axes.set(ylim=(len(rows) - 0.4, -0.6), xlabel=title)
        axes.tick_params(axis="y", length=0, labelcolor=look["ink"])
        axes.grid(axis="x", alpha=0.6)
        axes.spines["left"].set_visible(False)
        axes.set_axisbelow(True)
    return figure


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


class Panel(NamedTuple):
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
            with rc_context(PAGE.settings):
                figure = Figure(figsize=_CURVE, layout="constrained")
                draw_curves(figure.add_subplot(xlabel=xlabel, ylabel=ylabel), lines, PAGE)
            areas = ", ".join(f"{line.label} {line.ys.mean():.3f}" for line in lines)
            panels.append(Panel(maker.make(figure, f"{title}; areas: {areas}"), title))
    return panels


def main_panel(aggregates: Aggregates, maker: SvgMaker) -> Panel | None:
    """Draw the first ranked metric of all systems, with intervals; None without any."""
    figure, column = intervals_figure(aggregates, PAGE), RANKED[0]
    if figure is None:
        return None
    means = ((label, found.get(column.key)) for label, found in aggregates.overall.items())
    words = ", ".join(f"{label} {s.mean:.{column.decimals}f}" for label, s in means if s)
    svg = maker.make(figure, f"{column.label}: {words}")
    return Panel(svg, f"{column.label}: mean, 95 % interval, and each recording")


def error_panels(
    runs: Mapping[str, Sequence[ScoredRun]], truths: Mapping[int, Truth], maker: SvgMaker
) -> list[Panel]:
    """Draw the error over time on one recording, one panel for each system."""
    series = error_series(runs, truths)
    panels = []
    for label, errors in series.errors.items():
        with rc_context(PAGE.settings):
            figure = Figure(figsize=_SMALL)
            # A fixed place: to lay out each figure takes longer than to draw it.
            axes = figure.add_axes(_PLACE, xlabel="frame", ylabel="error, px")
            draw_errors(axes, series, label, PAGE)
        median = float(np.nanmedian(errors))
        svg = maker.make(figure, f"Error of {label} over time; median {median:.1f} px")
        panels.append(Panel(svg, label))
    return panels
