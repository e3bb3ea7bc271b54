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

"""Figures of runs, readable in grey and for colour-blind readers."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, Stroke

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.occlusions import CLOSE_PX
from vehicle_pf_tracker.evaluation.scores import Scores
from vehicle_pf_tracker.offline.output_files import replacing


class Style(NamedTuple):
    """Colour, line and marker of one series."""

    colour: str
    line: str | tuple[int, tuple[int, ...]]
    marker: str


# The colours are Okabe and Ito's. Lines tell series apart over time; in the path, where a dashed
# line means hidden, markers do.
STYLES = (
    Style("#0072B2", "-", "o"),
    Style("#D55E00", "--", "s"),
    Style("#009E73", "-.", "^"),
    Style("#CC79A7", ":", "D"),
    Style("#E69F00", (0, (5, 1, 1, 1, 1, 1)), "v"),
    Style("#56B4E9", (0, (8, 2)), "P"),
)
_SHADES = {Occlusion.PARTIAL: ("0.93", "partly hidden"), Occlusion.TOTAL: ("0.78", "hidden")}
_LEAST_ERROR = 0.5
"""Foot of the logarithmic scale, px: smaller errors are below the truth's own precision."""
_MARKER_EVERY = 20
_DPI = 150
_DASHED = (0, (2, 1.4))
OUTLINE = (Stroke(linewidth=3.4, foreground="white", alpha=0.8), Normal())
"""Keeps lines visible on any scenery."""


def draw_errors(axes: Axes, runs: Mapping[str, Scores], title: str) -> None:
    """Draw the error over time, with the occlusions shaded and without a legend."""
    for scores in itertools.islice(runs.values(), 1):
        shade_occlusions(axes, scores)
    for (name, scores), style in zip(runs.items(), itertools.cycle(STYLES), strict=False):
        drawn = [(f.row.frame, f.error) for f in scores.counted]
        errors = [float("nan") if e is None else max(e, _LEAST_ERROR) for _, e in drawn]
        frames = [number for number, _ in drawn]
        axes.plot(frames, errors, color=style.colour, linestyle=style.line, lw=1.6, label=name)
    axes.axhline(CLOSE_PX, color="0.35", lw=0.8, ls=(0, (1, 2)), label=f"{CLOSE_PX:g} px")
    axes.set(xlabel="frame", ylabel="error of the centre, px", yscale="log", title=title)
    axes.yaxis.set_major_formatter("{x:g}")
    axes.margins(x=0.01)
    axes.grid(axis="y", color="0.88", lw=0.6)
    axes.set_axisbelow(True)


def overview_figure(frame: Frame, runs: Mapping[str, Scores], title: str = "") -> Figure:
    """Draw the true and estimated paths over a frame, and the error over time below.

    Paths are dashed where the vehicle is hidden.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    runs : mapping of str to Scores
        Runs on one recording, by the name in the legend.
    title : str
        Title above the figure.
    """
    width, height = frame_size(frame)
    figure = Figure(figsize=(9, 9 * height / width + 4.5), layout="constrained")
    ratios = (9 * height / width + 0.8, 3.7)
    rows = figure.subfigures(2, 1, squeeze=False, height_ratios=ratios)[:, 0]
    _draw_paths(rows[0].add_subplot(), frame, runs, title)
    axes = rows[1].add_subplot()
    draw_errors(axes, runs, "")
    _add_legend(axes)
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write `figure` to the file `path`, whose suffix names the format.

    The same figure gives the same file: no date is written, and names within it are not random.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    metadata = {"Date": None} if path.suffix == ".svg" else {}
    with replacing(path) as partial, rc_context({"svg.hashsalt": "vehicle_pf_tracker"}):
        figure.savefig(partial, dpi=_DPI, metadata=metadata)


def _draw_paths(axes: Axes, frame: Frame, runs: Mapping[str, Scores], title: str) -> None:
    width, height = frame_size(frame)
    axes.imshow(frame, extent=(0, width, height, 0))
    for scores in itertools.islice(runs.values(), 1):
        true = [(f.truth.box.centre if f.truth else None, f.hidden) for f in scores.frames]
        _draw_path(axes, true, "truth", "black", "")
        _draw_first_box(axes, scores)
    for (name, scores), style in zip(runs.items(), itertools.cycle(STYLES), strict=False):
        estimated = [(f.row.position, f.hidden) for f in scores.frames]
        _draw_path(axes, estimated, name, style.colour, style.marker)
    axes.plot([], [], color="0.4", lw=1.7, ls=_DASHED, label="while hidden")
    axes.set(xlim=(0, width), ylim=(height, 0), xlabel="x, px", ylabel="y, px", title=title)
    _add_legend(axes)


def _add_legend(axes: Axes) -> None:
    """Put the legend below the axis labels; the pad is in font sizes."""
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, 0.0), borderaxespad=3.6, ncols=6, frameon=False
    )


def shade_occlusions(axes: Axes, scores: Scores) -> None:
    """Shade the frames in which the vehicle is partly or totally hidden."""
    truths = {frame.row.frame: frame.truth for frame in scores.frames if frame.truth is not None}
    for occlusion, (shade, label) in _SHADES.items():
        for index, (first, last) in enumerate(stretches(truths, {occlusion})):
            shown = None if index else label
            axes.axvspan(first - 0.5, last + 0.5, color=shade, lw=0, label=shown)


def stretches(truths: Mapping[int, Truth], kinds: Collection[Occlusion]) -> list[tuple[int, int]]:
    """Return the first and last frames of the stretches with an occlusion of these kinds.

    Truths are given by the number of their frame.
    """
    grouped = itertools.groupby(sorted(truths), lambda number: truths[number].occlusion in kinds)
    found = [list(numbers) for matches, numbers in grouped if matches]
    return [(numbers[0], numbers[-1]) for numbers in found]


def _draw_path(
    axes: Axes,
    points: Sequence[tuple[tuple[float, float] | None, bool]],
    name: str,
    colour: str,
    marker: str,
) -> None:
    """Draw a path solid where it is seen and dashed where hidden; None breaks it."""
    for hidden, line in _lines(points):
        xs, ys = zip(*line, strict=True)
        style = _DASHED if hidden else "-"
        axes.plot(xs, ys, color=colour, lw=1.7, ls=style, path_effects=OUTLINE)
    marks = [point for point, _ in points[::_MARKER_EVERY] if point is not None]
    xs, ys = zip(*marks, strict=True) if marks and marker else ((), ())
    axes.plot(xs, ys, ls="", color=colour, marker=marker, ms=6, mec="white", mew=0.8)
    axes.plot([], [], color=colour, marker=marker, ms=6, mec="white", mew=0.8, label=name)


def _lines(
    points: Sequence[tuple[tuple[float, float] | None, bool]],
) -> Iterator[tuple[bool, list[tuple[float, float]]]]:
    """Stretches of one kind, each begun where the one before ended so that no gap shows."""
    last: tuple[float, float] | None = None
    for (hidden, gap), group in itertools.groupby(points, lambda p: (p[1], p[0] is None)):
        if gap:
            last = None
            continue
        line = [point for point, _ in group if point is not None]
        yield hidden, [last, *line] if last is not None else line
        last = line[-1]


def _draw_first_box(axes: Axes, scores: Scores) -> None:
    box = next((f.truth.box for f in scores.counted if f.truth is not None), None)
    if box is not None:
        corners = [*box.corners, box.corners[0]]
        xs, ys = zip(*corners, strict=True)
        axes.plot(xs, ys, color="black", lw=1.2, path_effects=OUTLINE)
