# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 3 of the first paper: the similarity in each frame, over the width of the occlusion."""

from __future__ import annotations

from collections.abc import Callable
from statistics import fmean, median
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf.systems import (
    BAR_SETTING,
    INTERPRETATIONS,
    INTERPRETATIONS_NOTE,
    VEHICLE_SPEED,
    artificial_video,
    covered,
    with_sigma,
)
from reproduction.numbers import (
    counted,
    median_and_range,
    rank_correlation,
    share,
)
from reproduction.runs.cells import Result, RunCell
from vehicle_pf_tracker.evaluation.scores import CLOSE_PX

_WIDTHS = tuple(range(0, 121, 2)), (0, 30, 60, 120)
"""Widths of the bar from the paper's least to its largest, px, in full and quick."""
_PLACE = "section IV, figure 3"
_RECORD = ("pi", "regime", "x", "y")
_LAST = 10
"""Frames at the end that tell whether the vehicle is followed again."""
_RESUMED = 0.5
"""Least share of these frames in the regular mode that counts as resumed."""
_MONOTONE = 0.9
"""Least rank correlation at which one quantity counts as growing with another, a choice."""


def cells(size: ex.Size) -> list[RunCell]:
    """Run every interpretation on every width with every seed."""
    return [
        _cell(interpretation, width, seed)
        for width in size.of(*_WIDTHS)
        for interpretation in INTERPRETATIONS
        for seed in size.seeds
    ]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Show the first seed's similarities as grey levels, and judge all seeds."""
    truths = {width: artificial_video(width).truths() for width in size.of(*_WIDTHS)}
    ends = {
        width: [truth.box.centre for truth in of_width[-_LAST:]]
        for width, of_width in truths.items()
    }
    runs = {
        (interpretation, width, seed): results[_cell(interpretation, width, seed)]
        for interpretation in INTERPRETATIONS
        for width in size.of(*_WIDTHS)
        for seed in size.seeds
    }
    table = _Runs(runs, ends, size)
    spans = {width: covered(of_width) for width, of_width in truths.items()}
    return ex.Report(_data(runs), _figure(runs, spans, size), _verdict(table))


def _cell(interpretation: str, width: int, seed: int) -> RunCell:
    system = with_sigma(INTERPRETATIONS[interpretation], VEHICLE_SPEED)
    return RunCell(artificial_video(width), system, seed, _RECORD)


class _Runs:
    """The quantities that the claims are about, of every run."""

    def __init__(
        self,
        runs: dict[tuple[str, int, int], Result],
        ends: dict[int, list[tuple[float, float]]],
        size: ex.Size,
    ) -> None:
        self._runs = runs
        self._ends = ends
        self.widths = size.of(*_WIDTHS)
        self.seeds = size.seeds

    def of(self, interpretation: str, what: Callable[[int, Result], Any]) -> list[Any]:
        """Apply `what` to width and result of all runs under an interpretation."""
        return [
            what(width, run)
            for (name, width, _), run in self._runs.items()
            if name == interpretation
        ]

    def by_width(self, interpretation: str, what: Callable[[Result], float]) -> list[float]:
        """Take the median over the seeds for each width."""
        return [
            median(what(self._runs[interpretation, width, seed]) for seed in self.seeds)
            for width in self.widths
        ]

    def end_error(self, width: int, run: Result) -> float:
        """Mean error over the last frames, px."""
        estimated = zip(run["trace"]["x"][-_LAST:], run["trace"]["y"][-_LAST:], strict=True)
        with_truth = zip(estimated, self._ends[width], strict=True)
        return fmean(float(np.hypot(x - tx, y - ty)) for (x, y), (tx, ty) in with_truth)


def _occluded_frames(run: Result) -> int:
    return sum(regime == "occlusion" for regime in run["trace"]["regime"])


def _least_pi(run: Result) -> float:
    similarities: list[float | None] = run["trace"]["pi"]
    return min(pi for pi in similarities if pi is not None)


def _has_resumed(width: int, run: Result) -> bool:
    last = run["trace"]["regime"][-_LAST:]
    return share([regime == "regular" for regime in last]) >= _RESUMED


def _data(runs: dict[tuple[str, int, int], Result]) -> ex.DataTable:
    rows: list[tuple[ex.Entry, ...]] = []
    for point, run in runs.items():
        trace = run["trace"]
        columns = zip(trace["pi"], trace["regime"], trace["x"], trace["y"], strict=True)
        rows += [(*point, frame, *values) for frame, values in enumerate(columns, start=1)]
    return ex.DataTable(
        ("interpretation", "width", "seed", "frame", "pi", "regime", "x", "y"), tuple(rows)
    )


def _figure(
    runs: dict[tuple[str, int, int], Result],
    spans: dict[int, tuple[int, int] | None],
    size: ex.Size,
) -> Figure:
    widths = size.of(*_WIDTHS)
    seed = size.seeds[0]
    figure = Figure(figsize=(11, 4.4), layout="constrained")
    axes = figure.subplots(1, len(INTERPRETATIONS), sharey=True)
    for ax, interpretation in zip(axes, INTERPRETATIONS, strict=True):
        # The first frame has no similarity yet: it is the reference.
        levels = np.array(
            [runs[interpretation, width, seed]["trace"]["pi"][1:] for width in widths]
        )
        frames = np.arange(2, levels.shape[1] + 2)
        image = ax.pcolormesh(
            frames, widths, levels, shading="nearest", cmap="gray", vmin=0, vmax=1,
            rasterized=True,
        )  # fmt: skip
        _outline(ax, spans)
        ax.set(title=interpretation, xlabel="frame")
    axes[0].set(ylabel="width of the occlusion, px")
    figure.colorbar(image, ax=axes, label="Pi")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", frameon=False)
    return figure


def _outline(axes: Axes, spans: dict[int, tuple[int, int] | None]) -> None:
    """Draw where the bar begins and ends to cover a part of the vehicle."""
    covering = [(width, span) for width, span in spans.items() if span is not None]
    for end, label in ((0, "the bar covers a part of the vehicle, or all of it"), (1, None)):
        frames = [span[end] for _, span in covering]
        axes.plot(
            frames, [width for width, _ in covering], color="#E69F00", ls="--", lw=1.3, label=label
        )


def _verdict(table: _Runs) -> ex.ExperimentVerdict:
    def claim(words: str, judge: Callable[[_Runs, str], ex.Finding], rule: str) -> ex.Claim:
        findings = tuple(judge(table, interpretation) for interpretation in INTERPRETATIONS)
        return ex.Claim(words, _PLACE, findings, rule)

    return ex.ExperimentVerdict(
        (
            claim(
                "the vehicle is tracked at every width from 0 to 120 px",
                _tracked,
                "yes: 95 % of the runs are; partly: half",
            ),
            claim(
                "the wider the occlusion, the more frames are in occlusion mode",
                _longer,
                "yes: a rank correlation of at least 0.9; partly: 0.5",
            ),
            claim(
                "the wider the occlusion, the lower the similarity falls in it",
                _deeper,
                "yes: a rank correlation of at most -0.9; partly: -0.5",
            ),
            claim(
                "after the occlusion the regular mode resumes",
                _resumed,
                "yes: in 95 % of the runs; partly: in half",
            ),
        ),
        f"{BAR_SETTING} The vehicle passes at {VEHICLE_SPEED:g} px/frame, sigma is the same "
        f"number; {len(table.widths)} widths, {len(table.seeds)} seeds. Grey levels are "
        "those of the first seed. "
        f"{INTERPRETATIONS_NOTE}",
    )


def _tracked(table: _Runs, interpretation: str) -> ex.Finding:
    errors = table.of(interpretation, table.end_error)
    hits = [error < CLOSE_PX for error in errors]
    wide = [
        width
        for width, hit in zip(table.of(interpretation, lambda w, _: w), hits, strict=True)
        if not hit
    ]
    failing = f"; misses from {min(wide)} px on" if wide and min(wide) else ""
    return ex.Finding(
        interpretation,
        ex.Holds.share(share(hits)),
        f"{counted(hits)} runs are within {CLOSE_PX:g} px over the last {_LAST} frames{failing}; "
        f"error there {median_and_range(errors)} px",
    )


def _longer(table: _Runs, interpretation: str) -> ex.Finding:
    frames = table.by_width(interpretation, _occluded_frames)
    rank = rank_correlation(table.widths, frames)
    return ex.Finding(
        interpretation,
        ex.Holds.of(rank >= _MONOTONE, rank >= 0.5),
        f"from {frames[0]:g} frames without a bar to {frames[-1]:g} at {table.widths[-1]} px "
        f"(medians); rank correlation {rank:.2f}",
    )


def _deeper(table: _Runs, interpretation: str) -> ex.Finding:
    least = table.by_width(interpretation, _least_pi)
    rank = rank_correlation(table.widths, least)
    return ex.Finding(
        interpretation,
        ex.Holds.of(rank <= -_MONOTONE, rank <= -0.5),
        f"least Pi from {least[0]:.2f} without a bar to {least[-1]:.2f} at {table.widths[-1]} px "
        f"(medians); rank correlation {rank:.2f}",
    )


def _resumed(table: _Runs, interpretation: str) -> ex.Finding:
    hits = table.of(interpretation, _has_resumed)
    return ex.Finding(
        interpretation,
        ex.Holds.share(share(hits)),
        f"in {counted(hits)} runs at least half of the last {_LAST} frames are regular",
    )


EXPERIMENT = ex.Experiment(
    "apf-fig3", "APF, figure 3: the similarity Pi over frames and the occlusion's width", cells,
    report,
)  # fmt: skip
