"""Table II as a picture: every tracker's error on every video, with its range over the seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median

import numpy as np
from matplotlib.figure import Figure

from vehicle_pf_tracker.evaluation.experiments.apf_systems import SIX
from vehicle_pf_tracker.evaluation.plots import STYLES
from vehicle_pf_tracker.scenes.videos import VIDEOS

_SHADES = {"total": "0.84", "partial and total": "0.84", "partial": "0.93", "none": "white"}
_SPREAD = 0.11
"""Distance of two trackers' marks at one video, in videos."""


def table_figure(videos: Mapping[str, Mapping[str, Sequence[float]]]) -> Figure:
    """Draw medians as marks and ranges as lines, on a logarithmic scale."""
    figure = Figure(figsize=(11, 4.6), layout="constrained")
    axes = figure.add_subplot()
    for place, name in enumerate(videos):
        axes.axvspan(place - 0.5, place + 0.5, color=_SHADES[VIDEOS[name].occlusion], lw=0)
    for index, (system, style) in enumerate(zip(SIX, STYLES, strict=True)):
        places = np.arange(len(videos)) + (index - (len(SIX) - 1) / 2) * _SPREAD
        errors = [errors[system.label] for errors in videos.values()]
        axes.vlines(
            places, [min(e) for e in errors], [max(e) for e in errors], color=style.colour, lw=1.3
        )
        axes.plot(
            places, [median(e) for e in errors], ls="", marker=style.marker, ms=6, mec="black",
            mew=0.5, color=style.colour, label=system.label,
        )  # fmt: skip
    axes.set_xticks(range(len(videos)), [name.removeprefix("video") for name in videos])
    axes.set(
        xlim=(-0.5, len(videos) - 0.5), yscale="log", ylabel="RMSE, px",
        xlabel="video (dark ground: total occlusion, light: partial, white: none)",
    )  # fmt: skip
    axes.yaxis.set_major_formatter("{x:g}")
    axes.grid(axis="y", color="0.7", lw=0.5)
    axes.set_axisbelow(True)
    figure.legend(loc="outside lower center", ncols=len(SIX), frameon=False)
    return figure
