# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 6 of the first paper: the error in each frame, of all six trackers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import TypeAlias

from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf import video3
from reproduction.apf.systems import APF_RIVALS, INTERPRETATIONS, SIX_SYSTEMS
from reproduction.drawing.bands import BANDS_NOTE, draw_band, legend_of, log_errors
from reproduction.drawing.shading import shade_occlusions
from reproduction.numbers import median_and_range
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES
from vehicle_pf_tracker.evaluation.occlusion_scores import SETTLING_FRAMES
from vehicle_pf_tracker.evaluation.scores import Scores

_PLACE = "section IV, figure 6"


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the first seed's errors, and judge all seeds."""
    runs = video3.all_scores(results, size)
    return ex.Report(
        video3.data(runs, size),
        _figure(runs),
        _verdict(runs, size),
        {"Median of the seeds' mean errors, px:": _table(runs)},
    )


def _figure(runs: Mapping[str, Sequence[Scores]]) -> Figure:
    figure = Figure(figsize=(10, 7), layout="constrained")
    linear, logarithmic = figure.subplots(2, 1, sharex=True)
    for axes in (linear, logarithmic):
        shade_occlusions(axes, runs[SIX_SYSTEMS[0].label][0])
        for system, style in zip(SIX_SYSTEMS, LINE_STYLES, strict=True):
            draw_band(axes, runs[system.label], style, system.label)
        axes.set(ylabel="error of the centre, px")
    linear.set(ylim=(0, None), title="linear, as in the paper")
    log_errors(logarithmic)
    logarithmic.set(xlabel="frame", title="logarithmic")
    legend_of(figure, (linear, logarithmic))
    return figure


def _mean_errors(of_seeds: Sequence[Scores]) -> tuple[list[float], list[float]]:
    """Mean error before the first and after the last total occlusion, for each seed."""
    before, after = [], []
    for scored in of_seeds:
        first, last = video3.total_span(scored)
        errors = [(f.row.frame, f.error) for f in scored.counted if f.error is not None]
        head = [error for frame, error in errors if frame < first]
        tail = [error for frame, error in errors if frame >= last + SETTLING_FRAMES]
        before.append(sum(head) / len(head))
        after.append(sum(tail) / len(tail))
    return before, after


def _table(runs: dict[str, list[Scores]]) -> ex.DataTable:
    rows = []
    for label, of_seeds in runs.items():
        before, after = _mean_errors(of_seeds)
        rows.append((label, median_and_range(before), median_and_range(after)))
    return ex.DataTable(
        ("tracker", "before the first total occlusion", "after the last"), tuple(rows)
    )


def _verdict(runs: dict[str, list[Scores]], size: ex.Size) -> ex.ExperimentVerdict:
    rivals = {rival.label: _mean_errors(runs[rival.label]) for rival in APF_RIVALS}
    findings = tuple(
        _finding(interpretation, _mean_errors(runs[system.label]), rivals)
        for interpretation, system in INTERPRETATIONS.items()
    )
    return ex.ExperimentVerdict(
        (
            ex.Claim(
                "before and after the total occlusions APF's errors are smaller than the others'",
                _PLACE,
                findings,
                "yes: its median over the seeds is at most the best rival's, before and after; "
                "partly: before or after",
            ),
        ),
        f"{video3.SETTING} {len(size.seeds)} seeds. {BANDS_NOTE} "
        f'"After" begins {SETTLING_FRAMES} frames after the last hidden one.',
    )


_Means: TypeAlias = tuple[list[float], list[float]]
"""Mean error of each seed before the first and after the last total occlusion, px."""


def _finding(interpretation: str, ours: _Means, rivals: Mapping[str, _Means]) -> ex.Finding:
    smaller = []
    words = []
    for index, when in enumerate(("before", "after")):
        best = min(rivals, key=lambda label: median(rivals[label][index]))
        smaller.append(median(ours[index]) <= median(rivals[best][index]))
        words.append(
            f"{when}: {median_and_range(ours[index])} px against {best}'s "
            f"{median_and_range(rivals[best][index])} px"
        )
    return ex.Finding(interpretation, ex.Holds.of(all(smaller), any(smaller)), "; ".join(words))


EXPERIMENT = ex.Experiment(
    "apf-fig6", "APF, figure 6: the error in each frame, of all six trackers", video3.cells, report
)
