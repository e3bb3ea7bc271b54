# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The second paper's figures 5 to 15: a plot over the frames for each case."""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction.drawing.bands import legend_of
from reproduction.experiment import Size
from reproduction.mfpf import systems as mfpf

_COLUMNS = 2
"""Cases side by side: the curves of 70 frames and more need half a page's width each."""
_WIDTH = 11.0
"""Width of the figure, inches."""
_LEGEND_HEIGHT = 0.5
"""Room below the axes for one row of the legend, inches."""


def draw_by_case(
    size: Size,
    draw: Callable[[Axes, str], None],
    value: str,
    *,
    height: float,
    one_scale: bool = False,
) -> Figure:
    """Let `draw` fill the plot of each case.

    Parameters
    ----------
    size : Size
        Says which cases there are.
    draw : callable
        Draws one case, with labels for the legend below all.
    value : str
        Label of the y axes.
    height : float
        Height of one plot, inches.
    one_scale : bool
        True if all share one y axis.
    """
    names = mfpf.cases(size)
    rows = -(-len(names) // _COLUMNS)
    figure = Figure(figsize=(_WIDTH, height * rows + _LEGEND_HEIGHT), layout="constrained")
    axes = figure.subplots(rows, _COLUMNS, sharey=one_scale, squeeze=False)
    for ax, case in zip(axes.flat, names, strict=True):
        draw(ax, case)
        ax.set_title(f"case {case[-1]}: {mfpf.occlusion_text(case)}", fontsize="medium")
        ax.set(xlabel="")
    for ax in axes[-1]:
        ax.set(xlabel="frame")
    for ax in axes[:, 0] if one_scale else axes.flat:
        ax.set(ylabel=value)
    legend_of(figure, axes.flat)
    return figure
