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
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, Stroke

from vehicle_pf_tracker.core.box import Position
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
    _draw_paths(rows[0].add_subplot(title=title), frame, runs)
    _draw_errors(rows[1].add_subplot(), runs)
    for part in rows:  # below the labels of the axes; the pad is in font sizes
        part.axes[0].legend(
            loc="upper center", bbox_to_anchor=(0.5, 0.0), borderaxespad=3.6, ncols=6,
            frameon=False,
        )  # fmt: skip
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


def _draw_errors(axes: Axes, runs: Mapping[str, Scores]) -> None:
    """Draw the error over time, with the occlusions shaded."""
    for scores in itertools.islice(runs.values(), 1):
        shade_occlusions(axes, scores)
    for (name, scores), style in zip(runs.items(), itertools.cycle(STYLES), strict=False):
        frames = [frame.row.frame for frame in scores.counted]
        errors = np.array([frame.error for frame in scores.counted], dtype=np.float64)
        errors = np.maximum(errors, _LEAST_ERROR)
        axes.plot(frames, errors, color=style.colour, linestyle=style.line, lw=1.6, label=name)
    axes.axhline(CLOSE_PX, color="0.35", lw=0.8, ls=(0, (1, 2)), label=f"{CLOSE_PX:g} px")
    axes.set(xlabel="frame", ylabel="error of the centre, px", yscale="log")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.margins(x=0.01)
    axes.grid(axis="y", color="0.88", lw=0.6)
    axes.set_axisbelow(True)


def _draw_paths(axes: Axes, frame: Frame, runs: Mapping[str, Scores]) -> None:
    width, height = frame_size(frame)
    axes.imshow(frame, extent=(0, width, height, 0))
    for scores in itertools.islice(runs.values(), 1):
        true = [frame.truth.box.centre if frame.truth else None for frame in scores.frames]
        _draw_path(axes, true, scores, "truth", Style("black", "-", ""))
        for first in itertools.islice((f.truth for f in scores.counted if f.truth), 1):
            corners = [*first.box.corners, first.box.corners[0]]
            axes.plot(*zip(*corners, strict=True), color="black", lw=1.2, path_effects=OUTLINE)
    for (name, scores), style in zip(runs.items(), itertools.cycle(STYLES), strict=False):
        _draw_path(axes, [frame.row.position for frame in scores.frames], scores, name, style)
    axes.plot([], [], color="0.4", lw=1.7, ls=_DASHED, label="while hidden")
    axes.set(xlim=(0, width), ylim=(height, 0), xlabel="x, px", ylabel="y, px")


def _draw_path(
    axes: Axes, points: Sequence[Position | None], scores: Scores, name: str, style: Style
) -> None:
    """Draw a path solid where the vehicle is seen and dashed where it is hidden; None breaks it."""
    path = np.array([point or (np.nan, np.nan) for point in points])
    hidden = np.array([frame.hidden for frame in scores.frames])
    for is_hidden, line in ((False, "-"), (True, _DASHED)):
        shown = hidden == is_hidden
        shown[:-1] |= shown[1:]  # from where the part before ended, so that no gap shows
        part = np.where(shown[:, np.newaxis], path, np.nan)
        axes.plot(*part.T, color=style.colour, lw=1.7, ls=line, path_effects=OUTLINE)
    marks: dict[str, Any] = {"marker": style.marker, "ms": 6, "mec": "white", "mew": 0.8}
    if style.marker:
        axes.plot(*path[::_MARKER_EVERY].T, ls="", color=style.colour, **marks)
    axes.plot([], [], color=style.colour, label=name, **marks)


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
