# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures of a report: success and precision, errors over time."""

from __future__ import annotations

import html
import io
import re
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.curves import Curve
from vehicle_pf_tracker.evaluation.evaluation_folder import safe_name
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES
from vehicle_pf_tracker.evaluation.occlusion_stretches import stretches
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun
from vehicle_pf_tracker.evaluation.scores import CLOSE_PX
from vehicle_pf_tracker.results.output_files import make_folder, replacing

FIGURE_COLOURS: Mapping[str, str] = {
    "ink": "#010101",
    "muted": "#404040",
    "rule": "#b0b0b0",
    "total": "#c9ced4",
    "partial": "#e9ecef",
    "accent": "#0a5c9e",
    **{f"s{slot}": style.colour.lower() for slot, style in enumerate(LINE_STYLES)},
}
"""Colours of figures in files. On the page, which has schemes, each is ``var(--name)``: so no two
are the same, and none is a black that SVG leaves out."""
INK = FIGURE_COLOURS["ink"]
MUTED = FIGURE_COLOURS["muted"]
RULE = FIGURE_COLOURS["rule"]
ACCENT = FIGURE_COLOURS["accent"]
_LETTERS = 8.0
"""Size of the letters, points: as large as captions; the smallest that IEEE advises is 8."""
_NARROW = 3.9
"""Width of a figure, inches: two stand beside each other on the page of the report."""
_WIDE = 10.2
"""Width of a row of panels, inches: that of the page."""
SETTINGS: Any = {
    "svg.fonttype": "none",  # the reader's fonts
    "svg.hashsalt": "vehicle_pf_tracker",
    "pdf.fonttype": 42,  # journals refuse matplotlib's usual Type 3
    "font.size": _LETTERS,
    "axes.edgecolor": RULE,
    "axes.labelcolor": MUTED,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "text.color": INK,
    "xtick.color": RULE,
    "ytick.color": RULE,
    "xtick.labelcolor": MUTED,
    "ytick.labelcolor": MUTED,
    "grid.color": RULE,
    "grid.linewidth": 0.5,
}
"""Settings that figures are made and written under; see `matplotlib.rc_context`."""
_PAPER_WIDTHS = {_NARROW: 3.5, _WIDE: 7.16}
"""A column and the page in IEEE's two-column layout, inches."""
_DPI = 300
"""Resolution of PNG files, which IEEE asks of colour pictures."""
_METADATA: Mapping[str, Any] = {
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
}
"""No date and no version, so that the same folder gives the same files."""


CURVES = {
    "success": ("Success", "overlap threshold", "share of frames above"),
    "precision": ("Precision", "error threshold, px", "share of frames below"),
    "normalised": ("Normalised precision", "error threshold, box sizes", "share of frames below"),
}
"""Title and names of the axes of each curve."""
ERRORS_PREFIX = "errors_"
"""Beginning of the names of figures of errors over time; the recording follows."""
LEAST_ERROR = 0.5
"""Errors below this, in px, are drawn at the foot of the logarithmic scale: truth that was drawn by
hand errs by about a pixel."""
_PANEL_HEIGHT = 1.35
"""Height of a panel of errors over time, inches: three in a row are then about 5 to 3."""
_PANELS_IN_A_ROW = 3
"""Panels beside each other: their words are then as large as those of the page."""


class Drawn(NamedTuple):
    """A figure, its caption, and the words that it is read out with."""

    figure: Figure
    caption: str
    spoken: str


def styled(aggregates: Aggregates) -> dict[str, int]:
    """Assign styles, by their number, to the first systems."""
    return {label: slot for slot, label in enumerate(aggregates.order[: len(LINE_STYLES)])}


def draw_all(evaluation: ScoredEvaluation, aggregates: Aggregates) -> dict[str, Drawn]:
    """Draw every figure of an evaluation that there are numbers for, by name."""
    with rc_context(SETTINGS):
        found = {name: _curves(evaluation, aggregates, name) for name in CURVES}
        for entry in evaluation.folder.recordings:
            runs = evaluation.by_system(entry.name, aggregates.order)
            truths = evaluation.truths[entry.name]
            found[ERRORS_PREFIX + safe_name(entry.name)] = _errors(runs, truths)
    return {name: drawn for name, drawn in found.items() if drawn is not None}


def write_figures(
    evaluation: ScoredEvaluation, aggregates: Aggregates, formats: Sequence[str]
) -> None:
    """Write every figure to ``figures/`` in each of the formats, in the widths of a paper.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    folder = make_folder(evaluation.folder.path / "figures")
    for name, drawn in draw_all(evaluation, aggregates).items():
        width, height = drawn.figure.get_size_inches()
        drawn.figure.set_size_inches(_PAPER_WIDTHS[width], height)
        with rc_context({**SETTINGS, "svg.fonttype": "path"}):  # the same in every program
            # Laid out once: each drawing moves a constrained layout a little further.
            drawn.figure.draw_without_rendering()
            drawn.figure.set_layout_engine("none")
            for kind in formats:
                path = folder / f"{name}.{kind}"
                with replacing(path) as partial:
                    drawn.figure.savefig(partial, format=kind, dpi=_DPI, metadata=_METADATA[kind])


def _curves(evaluation: ScoredEvaluation, aggregates: Aggregates, name: str) -> Drawn | None:
    """Draw a curve of `CURVES`: means over the seeds of a recording, then over recordings.

    The first of those with a style is on top; the others are grey, and not in the legend.
    """
    # 1. Mean curves; recordings weigh alike, however many seeds they have.
    lines: dict[str, Curve] = {}
    slots = styled(aggregates)
    for label in aggregates.order:
        curves = [
            [run.curves[name] for run in evaluation.of(entry.name, label) if name in run.curves]
            for entry in evaluation.folder.recordings
        ]
        means = [np.mean([curve.shares for curve in some], axis=0) for some in curves if some]
        if means:
            thresholds = next(curve.thresholds for some in curves for curve in some)
            lines[label] = Curve(thresholds, np.mean(means, axis=0))
    if not lines:
        return None
    # 2. The axes, with room below for two columns of names.
    title, xlabel, ylabel = CURVES[name]
    rows = -(-sum(label in slots for label in lines) // 2)
    figure = Figure(figsize=(_NARROW, 2.2 + 0.16 * rows), layout="constrained")
    axes = figure.add_subplot(xlabel=xlabel, ylabel=ylabel, ylim=(0, 1))
    # 3. The best last, and so on top.
    for label, line in reversed(lines.items()):
        style: dict[str, Any] = {"color": MUTED, "lw": 0.7, "alpha": 0.55}
        if label in slots:
            slot = slots[label]
            style = {
                "color": FIGURE_COLOURS[f"s{slot}"],
                "ls": LINE_STYLES[slot].line,
                "lw": 1.7,
                "label": label,
            }
        axes.plot(line.thresholds, line.shares, **style)
        axes.set_xlim(float(line.thresholds[0]), float(line.thresholds[-1]))
    axes.grid(axis="y", alpha=0.6)
    axes.set_axisbelow(True)
    # 4. The legend, the best first again.
    handles, labels = axes.get_legend_handles_labels()  # drawn last to first
    figure.legend(
        handles[::-1],
        labels[::-1],
        loc="outside lower center",
        ncols=2,
        frameon=False,
        handlelength=2.8,
    )
    areas = ", ".join(f"{label} {line.auc:.3f}" for label, line in lines.items())
    return Drawn(figure, title, f"{title}; areas: {areas}")


def draw_errors(axes: Axes, errors: Array) -> None:
    """Draw the error of a system over time: the median and the range over the seeds.

    Parameters
    ----------
    axes : Axes
        Drawn into.
    errors : (S, N) array
        Errors in px by seed and frame; NaN where nothing is scored.
    """
    # NaN stays NaN, and leaves a gap in the line.
    table = np.maximum(errors, LEAST_ERROR)
    frames = np.arange(1, table.shape[1] + 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # frames without truth have no median
        low = np.nanmin(table, axis=0)
        high = np.nanmax(table, axis=0)
        middle = np.nanmedian(table, axis=0)
    axes.fill_between(frames, low, high, color=ACCENT, alpha=0.25, lw=0)
    axes.plot(frames, middle, color=ACCENT, lw=1.2)
    axes.axhline(CLOSE_PX, color=MUTED, lw=0.7, ls=(0, (1, 2)))
    axes.set(yscale="log", xlim=(1, max(len(frames), 2)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.minorticks_off()


def _errors(runs: Mapping[str, Sequence[ScoredRun]], truths: Mapping[int, Truth]) -> Drawn | None:
    """Draw the errors over time, a panel for each system that has any, on shared axes."""
    tables = {
        label: np.stack(scored)
        for label, some in runs.items()
        if (scored := [run.errors for run in some if np.isfinite(run.errors).any()])
    }
    if not tables:
        return None
    highest = max(float(np.nanmax(table)) for table in tables.values())
    count = len(tables)
    columns = min(len(tables), _PANELS_IN_A_ROW)
    rows = -(-count // columns)
    size = _WIDE if columns > 1 else _NARROW, 0.3 + _PANEL_HEIGHT * rows
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    panels = list(grid.flat)
    for axes, (label, table) in zip(panels, tables.items(), strict=False):
        for kind in (Occlusion.PARTIAL, Occlusion.TOTAL):
            for first, last in stretches(truths, {kind}):
                axes.axvspan(first - 0.5, last + 0.5, color=FIGURE_COLOURS[kind.name.lower()], lw=0)
        draw_errors(axes, table)
        # At least to 100 px, so that good systems do not look bad by their scale; room above the
        # peak.
        axes.set_ylim(LEAST_ERROR, max(highest * 1.3, 100.0))
        axes.set_title(label, fontsize=_LETTERS, loc="left", pad=2.0)
    for axes in panels[count:]:
        axes.remove()
    for axes in panels[count - columns : count]:
        axes.tick_params(labelbottom=True)
    figure.supxlabel("frame", fontsize=_LETTERS, color=MUTED)
    figure.supylabel("error, px", fontsize=_LETTERS, color=MUTED)
    medians = (f"{label} {np.nanmedian(table):.1f} px" for label, table in tables.items())
    return Drawn(figure, "Error over time", f"Error over time; medians: {', '.join(medians)}")


def svg_element(drawn: Drawn, number: int) -> str:
    """Return a figure as an SVG element that is read out; its ids begin with its number."""
    text = io.StringIO()
    nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    with rc_context(SETTINGS):
        drawn.figure.savefig(text, format="svg", transparent=True, metadata=nothing)
    element = text.getvalue()
    element = element[element.index("<svg") :]
    element = re.sub(r"(<metadata>.*?</metadata>|<!--.*?-->)\s*", "", element, flags=re.DOTALL)
    # Figures share a page, where each id may occur once.
    element = re.sub(r' id="|href="#|url\(#', rf"\g<0>f{number}-", element)
    for name, colour in FIGURE_COLOURS.items():
        element = element.replace(colour, f"var(--{name})")
    size = re.search(r'viewBox="[^"]*"', element)
    assert size is not None
    head = f'<svg {size[0]} role="img" aria-label="{html.escape(drawn.spoken)}"'
    head += ' xmlns:xlink="http://www.w3.org/1999/xlink"'
    return re.sub(r"^<svg[^>]*", head, element).replace("\n", " ").replace("  ", " ")
