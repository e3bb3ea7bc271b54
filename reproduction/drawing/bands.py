# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Errors over the frames with a band over the seeds, linear as in the papers or logarithmic."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehicle_pf_tracker.evaluation.line_styles import Style
from vehicle_pf_tracker.evaluation.scores import CLOSE_PX, Scores

_QUARTILES = 25, 50, 75
"""Percentiles of the band and of its curve."""
_LEAST_ERROR = 0.5
"""Foot of the logarithmic scale, px: smaller errors are below the truth's own precision."""
BANDS_NOTE = (
    "Curves are the medians over the seeds, bands reach from the lower to the upper quartile; "
    "shades are the occlusions of the first seed."
)


def draw_band(axes: Axes, runs: Sequence[Scores], style: Style, label: str) -> None:
    """Draw the median error of each frame, and a band between the quartiles.

    Scenes of different seeds may differ by a frame or two in length: frames that not all have are
    left out.
    """
    errors = [[frame.error for frame in scored.frames] for scored in runs]
    count = min(map(len, errors))
    table = np.array([[np.nan if e is None else e for e in run[:count]] for run in errors])
    low, middle, high = np.maximum(np.nanpercentile(table, _QUARTILES, axis=0), _LEAST_ERROR)
    frames = np.arange(1, count + 1)
    axes.fill_between(frames, low, high, color=style.colour, alpha=0.18, lw=0)
    axes.plot(frames, middle, color=style.colour, ls=style.line, lw=1.8, label=label)
    axes.margins(x=0.01)
    axes.grid(axis="y", color="0.88", lw=0.6)
    axes.set_axisbelow(True)


def log_errors(axes: Axes) -> None:
    """Put errors in px on a logarithmic scale, with a line at what counts as close."""
    axes.axhline(CLOSE_PX, color="0.35", lw=0.8, ls=(0, (1, 2)), label=f"{CLOSE_PX:g} px")
    axes.set(yscale="log")
    axes.yaxis.set_major_formatter("{x:g}")


def legend_of(figure: Figure, axes: Iterable[Axes], columns: int = 7) -> None:
    """Put one legend below all plots, each name once."""
    handles: dict[str, Artist] = {}
    for ax in axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    figure.legend(
        list(handles.values()),
        list(handles),
        loc="outside lower center",
        ncols=columns,
        frameon=False,
    )
