# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A table as a picture: every tracker's value on every scene, with its range over the seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES

OCCLUSION_SHADES = {
    "total": "0.84",
    "partial and total": "0.84",
    "partial": "0.93",
    "none": "white",
}
"""The ground of a scene by its kind of occlusion."""
GROUND_NOTE = "(dark ground: total occlusion, light: partial, white: none)"
_SPREAD = 0.66
"""Width that the marks of one scene take up together, in scenes."""

Values = Mapping[str, Mapping[str, Sequence[float]]]
"""One value for each seed, by scene and by tracker."""


def draw_cases(axes: Axes, values: Values, shades: Mapping[str, str]) -> None:
    """Draw medians as marks and ranges as lines.

    Parameters
    ----------
    axes : Axes
        Gets scenes along x.
    values : mapping
        Values by scene, and by the name in the legend.
    shades : mapping of str to str
        The ground of each scene, a grey of matplotlib.
    """
    labels = list(next(iter(values.values())))
    step = _SPREAD / len(labels)
    for place, name in enumerate(values):
        axes.axvspan(place - 0.5, place + 0.5, color=shades[name], lw=0)
    for index, (label, style) in enumerate(zip(labels, LINE_STYLES, strict=False)):
        places = np.arange(len(values)) + (index - (len(labels) - 1) / 2) * step
        of_tracker = [of_scene[label] for of_scene in values.values()]
        axes.vlines(
            places,
            [min(f) for f in of_tracker],
            [max(f) for f in of_tracker],
            color=style.colour,
            lw=1.3,
        )
        axes.plot(
            places,
            [median(f) for f in of_tracker],
            ls="",
            marker=style.marker,
            ms=6,
            mec="black",
            mew=0.5,
            color=style.colour,
            label=label,
        )
    axes.set(xlim=(-0.5, len(values) - 0.5))
    axes.grid(axis="y", color="0.7", lw=0.5)
    axes.set_axisbelow(True)


def error_case_figure(
    values: Values, shades: Mapping[str, str], names: Sequence[str], what: str
) -> Figure:
    """Draw errors on a logarithmic scale; `names` stand below the scenes, `what` says of what."""
    figure = Figure(figsize=(11, 4.6), layout="constrained")
    axes = figure.add_subplot()
    draw_cases(axes, values, shades)
    axes.set_xticks(range(len(values)), list(names))
    axes.set(yscale="log", ylabel="RMSE, px", xlabel=f"{what} {GROUND_NOTE}")
    axes.yaxis.set_major_formatter("{x:g}")
    figure.legend(loc="outside lower center", ncols=6, frameon=False)
    return figure
