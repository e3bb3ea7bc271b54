# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Picture of the calibration: how often ellipses hold the truth, and one drive with its ellipse."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from laboratory.uncertainty.runs import INSIDE_95, Runs
from vehicle_pf_tracker.results.output_files import replacing
from vehicle_pf_tracker.trackers.uncertainty_table import CALIBRATIONS

_SHOWN = {"fusion": "tab:blue", "apf": "tab:orange"}
"""Variants of the drive, and their colours."""
_DRIVE = "bridge"
"""Scene of the drive: one total occlusion in the middle."""
_LEVELS = np.linspace(0.02, 0.99, 60)
"""Probabilities whose ellipses are compared: from the middle of the cloud to nearly all of it."""


def draw(path: Path, paths: Mapping[str, list[Path]]) -> None:
    """Draw the picture into the file `path`.

    Parameters
    ----------
    path : Path
        PNG file.
    paths : mapping of str to list of Path
        Files of runs by variant.
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), width_ratios=(1, 1.5))
    _draw_levels(left, {name: Runs(files) for name, files in paths.items()})
    _draw_drive(right, paths)
    figure.tight_layout()
    with replacing(path) as partial:
        figure.savefig(partial, dpi=110)
    plt.close(figure)


def _draw_levels(axes: Axes, runs: Mapping[str, Runs]) -> None:
    """Share of frames inside ellipses of every level; on the diagonal they are as they claim."""
    # A normal distribution in two dimensions holds 1 - exp(-d²/2) within the distance d.
    bounds = -2 * np.log1p(-_LEVELS)
    for name, one in runs.items():
        squares, _ = one.calibrated(CALIBRATIONS[name])
        shares = [(squares <= bound).mean() for bound in bounds]
        style: dict[str, Any] = {"color": "0.75", "lw": 0.8}
        style |= {"color": _SHOWN[name], "label": name, "lw": 2} if name in _SHOWN else {}
        axes.plot(_LEVELS, shares, **style)
    axes.plot([0, 1], [0, 1], "k:", lw=1)
    # A band from 90 to 99 % of the frames around the published level of 95 %.
    axes.fill_between([0.94, 0.96], 0.9, 0.99, color="tab:green", alpha=0.4, lw=0)
    axes.set(
        xlabel="level of the ellipse",
        ylabel="frames whose truth it holds",
        xlim=(0, 1),
        ylim=(0, 1),
        title="all scenes (grey: the other variants)",
    )
    axes.legend(loc="lower right")


def _draw_drive(axes: Axes, paths: Mapping[str, list[Path]]) -> None:
    """Error in each frame of a drive, and the radius of the 95 % ellipse."""
    files = _files_of_drive(paths)
    if not files:
        axes.set(title=f"there are no runs of the scene `{_DRIVE}`", xticks=[], yticks=[])
        return
    for name, file in files.items():
        colour = _SHOWN[name]
        run = Runs([file])
        _, areas = run.calibrated(CALIBRATIONS[name])
        # The first frame is left out of a run.
        frames = np.arange(2, len(areas) + 2)
        radius = np.sqrt(INSIDE_95 * np.sqrt(areas))
        axes.fill_between(
            frames,
            0.05,
            radius,
            color=colour,
            alpha=0.2,
            lw=0,
            label=f"{name}: radius of the 95 % ellipse",
        )
        error = np.hypot(run["error_x"], run["error_y"])
        # On a logarithmic axis, which has no 0.
        axes.plot(frames, np.maximum(error, 0.05), color=colour, label=f"{name}: error")
        hidden = frames[run.is_occluded]
    axes.axvspan(hidden[0], hidden[-1], color="0.9", zorder=0, label="out of sight")
    axes.set(
        xlabel="frame",
        ylabel="px",
        yscale="log",
        ylim=(0.05, None),
        title=f"scene `{_DRIVE}`, seed {file.name.split('.')[2]}",
    )
    axes.legend(fontsize=8, loc="upper left")


def _files_of_drive(paths: Mapping[str, list[Path]]) -> dict[str, Path]:
    """Return the first run of the drive, ``VARIANT.SCENE.SEED.npy``, of each shown variant."""
    first: dict[str, Path] = {}
    for name in _SHOWN:
        for file in paths.get(name, ()):
            if file.name.split(".")[1] == _DRIVE:
                first.setdefault(name, file)
    return first
