# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strips of frames with the boxes that trackers put into them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import Normal, Stroke

from reproduction.runs.cells import SceneChoice
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES, Style
from vehicle_pf_tracker.evaluation.scores import Scores

_VIEW = 260, 150
"""Width and height in px of what is shown around the true position."""
_RIM = (Stroke(linewidth=3.6, foreground="black"), Normal())
"""Dark rim of a bright line, which keeps it visible on any ground."""


def telling_frames(scored: Scores, count: int) -> list[int]:
    """Choose frames: an early one, the ends and the middle of what hides the vehicle, a late one.

    Parameters
    ----------
    scored : Scores
        A run.
    count : int
        Number of frames, 3 at least.

    Returns
    -------
    list of int
        Frame numbers, from 1.
    """
    last = len(scored.frames) - 2
    covered = [f.row.frame for f in scored.frames if f.truth is not None and f.truth.occlusion]
    total = [f.row.frame for f in scored.frames if f.hidden]
    if not covered:
        return [int(number) for number in np.linspace(3, last, count).round()]
    ends = total or covered
    return [3, *(int(number) for number in np.linspace(ends[0], ends[-1], count - 2).round()), last]


def strip_figure(
    rows: Mapping[str, tuple[SceneChoice, Mapping[str, Scores], Sequence[int]]],
) -> Figure:
    """Draw a row of frames for each entry, cut to what is around the true position.

    A box that lies outside is told by an arrow of its colour that points to it.

    Parameters
    ----------
    rows : mapping of str to (SceneChoice, mapping of str to Scores, sequence of int)
        Rows by title: the scene, the runs on it by name, and the frames to show.
    """
    columns = max(len(numbers) for _, _, numbers in rows.values())
    height = 11 / columns * _VIEW[1] / _VIEW[0] + 0.25
    figure = Figure(figsize=(11, height * len(rows) + 0.4), layout="constrained")
    grid = figure.subplots(len(rows), columns, squeeze=False)
    for axes, (title, (choice, runs, numbers)) in zip(grid, rows.items(), strict=True):
        frames = _frames(choice, set(numbers))
        for ax, number in zip(axes, numbers, strict=True):
            _draw(ax, frames[number], runs, number)
            ax.set_title(f"frame {number}", fontsize="small", pad=2)
        axes[0].set_ylabel(title, fontsize="medium")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, frameon=False)
    return figure


def _frames(choice: SceneChoice, numbers: set[int]) -> dict[int, Frame]:
    shown = enumerate(choice.make().frames(), start=1)
    wanted = itertools.islice(shown, max(numbers))
    return {number: scene_frame.frame for number, scene_frame in wanted if number in numbers}


def _draw(axes: Axes, frame: Frame, runs: Mapping[str, Scores], number: int) -> None:
    truth = next(iter(runs.values())).frames[number - 1].truth
    assert truth is not None
    left, top = _corner(truth.box, frame)
    right, bottom = left + _VIEW[0], top + _VIEW[1]
    # In grey, so that the boxes stand out.
    grey = cv2.cvtColor(np.ascontiguousarray(frame[top:bottom, left:right]), cv2.COLOR_RGB2GRAY)
    axes.imshow(grey, cmap="gray", vmin=0, vmax=255, extent=(left, right, bottom, top))
    axes.set(xlim=(left, right), ylim=(bottom, top), xticks=[], yticks=[])
    _add_box(axes, truth.box, Style("black", "-", ""), 3.6)
    _add_box(axes, truth.box, Style("white", "-", ""), 2.0)
    axes.plot([], [], color="white", lw=2.0, label="truth", path_effects=_RIM)
    for (label, scored), style in zip(runs.items(), itertools.cycle(LINE_STYLES), strict=False):
        row = scored.frames[number - 1].row
        if row.x is not None and row.y is not None and row.width and row.height:
            box = Box.around((row.x, row.y), row.width, row.height)
            if left < row.x < right and top < row.y < bottom:
                _add_box(axes, box, style, 1.8)
            else:
                _point_to(axes, box.centre, style)
        axes.plot([], [], color=style.colour, ls=style.line, lw=1.8, label=label)


def _corner(box: Box, frame: Frame) -> tuple[int, int]:
    """Return the top left corner of the view, which stays in the frame."""
    height, width = frame.shape[:2]
    x, y = box.centre
    left = min(max(round(x - _VIEW[0] / 2), 0), width - _VIEW[0])
    return left, min(max(round(y - _VIEW[1] / 2), 0), height - _VIEW[1])


def _add_box(axes: Axes, box: Box, style: Style, width: float) -> None:
    axes.add_patch(
        Rectangle(
            (box.x, box.y),
            box.width,
            box.height,
            fill=False,
            ec=style.colour,
            ls=style.line,
            lw=width,
        )
    )


def _point_to(axes: Axes, place: tuple[float, float], style: Style) -> None:
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    x = min(max(place[0], left + 12), right - 12)
    y = min(max(place[1], top + 12), bottom - 12)
    dx, dy = place[0] - x, place[1] - y
    size = max(math.hypot(dx, dy), 1e-9)
    axes.annotate(
        "",
        (x + 10 * dx / size, y + 10 * dy / size),
        (x - 16 * dx / size, y - 16 * dy / size),
        arrowprops={"arrowstyle": "-|>", "color": style.colour, "lw": 1.8, "ls": style.line},
    )
