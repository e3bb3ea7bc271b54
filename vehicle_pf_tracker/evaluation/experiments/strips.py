"""Strips of frames with the boxes that trackers put into them."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from vehicle_pf_tracker.evaluation.experiments.cells import SceneChoice
from vehicle_pf_tracker.evaluation.plots import OUTLINE, STYLES
from vehicle_pf_tracker.evaluation.scores import Scores
from vehicle_pf_tracker.features.frame import Frame

_WIDTH = 320
"""Columns of a picture in the figure, so that its file stays small."""


def telling_frames(scored: Scores, count: int) -> list[int]:
    """Choose frames: an early one, the ends and the middle of what hides the vehicle, a late one.

    Parameters
    ----------
    scored : Scores
        A run.
    count : int
        How many, 3 at least.

    Returns
    -------
    list of int
        Frame numbers, from 1.
    """
    covered = [f.row.frame for f in scored.frames if f.truth is not None and f.truth.occlusion]
    total = [f.row.frame for f in scored.frames if f.hidden]
    ends = total or covered or [1, len(scored.frames)]
    middle = np.linspace(ends[0], ends[-1], count - 2).round().astype(int).tolist()
    return [3, *middle, len(scored.frames) - 2]


def strip_figure(
    rows: Mapping[str, tuple[SceneChoice, Mapping[str, Scores], Sequence[int]]],
    particles: Mapping[str, Mapping[int, Sequence[Sequence[float]]]] | None = None,
) -> Figure:
    """Draw a row of frames for each entry, cut to the rows of the image that the boxes are in.

    Parameters
    ----------
    rows : mapping of str to (SceneChoice, mapping of str to Scores, sequence of int)
        By the title of the row: the scene, the runs on it by name, and the frames to show.
    particles : mapping, optional
        By title and frame number: (x, y) of particles to be shown as dots.
    """
    columns = max(len(numbers) for _, _, numbers in rows.values())
    figure = Figure(figsize=(11, 1.75 * len(rows) + 0.4), layout="constrained")
    grid = figure.subplots(len(rows), columns, squeeze=False)
    for axes, (title, (choice, runs, numbers)) in zip(grid, rows.items(), strict=True):
        frames = _frames(choice, set(numbers))
        span = _rows_of_interest(runs, next(iter(frames.values())).shape[0])
        for ax, number in zip(axes, numbers, strict=True):
            dots = (particles or {}).get(title, {}).get(number, ())
            _draw(ax, frames[number], runs, number, span)
            if len(dots):
                ax.plot(*np.asarray(dots).T, ls="", marker=".", ms=1.5, color="yellow")
            ax.set_title(f"frame {number}", fontsize="small")
        axes[0].set_ylabel(title, fontsize="medium")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, frameon=False)
    return figure


def _frames(choice: SceneChoice, numbers: set[int]) -> dict[int, Frame]:
    shown = enumerate(choice.make().frames(), start=1)
    wanted = itertools.islice(shown, max(numbers))
    return {number: scene_frame.frame for number, scene_frame in wanted if number in numbers}


def _rows_of_interest(runs: Mapping[str, Scores], height: int) -> tuple[int, int]:
    """Rows of the image around the true path."""
    scored = next(iter(runs.values()))
    ys = [f.truth.box.centre[1] for f in scored.frames if f.truth is not None]
    middle, half = (min(ys) + max(ys)) / 2, max((max(ys) - min(ys)) / 2 + 60, 110)
    top = min(max(int(middle - half), 0), height - int(2 * half))
    return max(top, 0), min(max(top, 0) + int(2 * half), height)


def _draw(
    axes: Axes, frame: Frame, runs: Mapping[str, Scores], number: int, span: tuple[int, int]
) -> None:
    top, bottom = span
    # In grey, so that the boxes stand out; smaller, so that the file does.
    grey = cv2.cvtColor(frame[top:bottom], cv2.COLOR_RGB2GRAY)
    height, width = grey.shape
    small = cv2.resize(grey, (_WIDTH, round(height * _WIDTH / width)), interpolation=cv2.INTER_AREA)
    axes.imshow(small, cmap="gray", vmin=0, vmax=255, extent=(0, width, bottom, top))
    truth = next(iter(runs.values())).frames[number - 1].truth
    if truth is not None:
        box = truth.box
        axes.add_patch(
            Rectangle((box.x, box.y), box.width, box.height, fill=False, ec="white", lw=2.6)
        )
        axes.plot([], [], color="white", lw=2.6, label="truth", path_effects=OUTLINE)
    for (label, scored), style in zip(runs.items(), itertools.cycle(STYLES), strict=False):
        row = scored.frames[number - 1].row
        if row.x is not None and row.y is not None and row.width and row.height:
            corner = row.x - row.width / 2, row.y - row.height / 2
            axes.add_patch(
                Rectangle(corner, row.width, row.height, fill=False, ec=style.colour,
                          ls=style.line, lw=1.5)
            )  # fmt: skip
        axes.plot([], [], color=style.colour, ls=style.line, lw=1.5, label=label)
    axes.set(xlim=(0, width), ylim=(bottom, top), xticks=[], yticks=[])
