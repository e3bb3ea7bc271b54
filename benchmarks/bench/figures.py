# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures of a run, readable in grey and for colour-blind eyes."""

from __future__ import annotations

from matplotlib.figure import Figure

from benchmarks.bench.results import Results
from benchmarks.bench.targets import STEPS
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES


def steps_figure(results: Results) -> Figure:
    """Draw how many times faster than CSRT each variant's step is, and what is wanted."""
    found = {
        words[1]: case.ratio
        for case in results.cases
        if (words := case.name.split("/"))[0] == "step" and words[2] == "csrt"
    }
    # Sorted by what is shown: the order of the variants says nothing here.
    names = sorted(found, key=found.__getitem__)
    figure = Figure(figsize=(7, 0.6 + 0.32 * max(len(names), 1)), layout="constrained")
    axes = figure.add_subplot()
    axes.barh(names, [found[name] for name in names], color=LINE_STYLES[0].colour, height=0.65)
    wanted = [(STEPS[name], index) for index, name in enumerate(names) if name in STEPS]
    if wanted:
        axes.plot(
            *zip(*wanted, strict=True),
            ls="",
            marker="|",
            ms=14,
            mew=2.5,
            color=LINE_STYLES[1].colour,
            label="wanted",
        )
        axes.legend(frameon=False, loc="lower right")
    axes.set(xlabel="times faster than CSRT")
    axes.grid(axis="x", color="0.9", lw=0.6)
    axes.set_axisbelow(True)
    return figure
