# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 4 of the third paper: the error in each frame, before, during and after an occlusion."""

from __future__ import annotations

from statistics import median

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.drawing.bands import BANDS_NOTE, draw_band, legend_of, log_errors
from reproduction.drawing.shading import shade_occlusions
from reproduction.numbers import median_and_range
from reproduction.resampling import systems as resampling
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES

_PLACE = "section VI, figure 4"
_LOW = 15.0
"""RMSE in px that counts as on the vehicle."""
_ALIKE = 1.25
"""Ratios up to this count as almost the same."""
_HIGHER = 1.5
"""Ratio from which an error counts as much higher."""
_AT_MOST = 1.05
"""Ratio up to which an error is no higher: that of equal filters lies within a twentieth of 1."""

Errors = dict[str, dict[str, list[float]]]
"""RMSE of each seed, by filter and phase."""


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw all seeds' errors, and judge."""
    errors = {
        interpretation: _errors(results, size, interpretation)
        for interpretation in resampling.VIEWS
    }
    table = ex.DataTable(
        ("filter", *resampling.PHASES, "all"),
        tuple(
            (
                f"{variant}, {interpretation}",
                *(median_and_range(by_phase[name]) for name in (*resampling.PHASES, "all")),
            )
            for interpretation, by_filter in errors.items()
            for variant, by_phase in by_filter.items()
        ),
    )
    return ex.Report(
        resampling.data(results, size),
        _figure(results, size),
        ex.ExperimentVerdict(
            _claims(errors),
            f"{resampling.SETTING} {len(size.seeds)} seeds. {BANDS_NOTE} Left the paper's timing, "
            "right the harder scene; above on the paper's linear scale, below on a log one.",
        ),
        {"RMSE in px by phase, median and range over the seeds:": table},
    )


def _errors(results: ex.Results, size: ex.Size, interpretation: str) -> Errors:
    by_filter: Errors = {}
    view = resampling.VIEWS[interpretation]
    for system in view.pair:
        by_phase: dict[str, list[float]] = {name: [] for name in (*resampling.PHASES, "all")}
        for seed in size.seeds:
            scored = resampling.run_scores(results, view, system, seed)
            for name, chosen in resampling.phases(scored).items():
                by_phase[name].append(resampling.rms(scored, chosen))
            by_phase["all"].append(resampling.rms(scored, list(range(len(scored.frames)))))
        by_filter[system.variant] = by_phase
    return by_filter


def _figure(results: ex.Results, size: ex.Size) -> Figure:
    figure = Figure(figsize=(11, 6.4), layout="constrained")
    axes = figure.subplots(2, 2, sharex="col")
    titles = ex.PAPER_RULE, f"{ex.PAPER_RULE}{resampling.HARD}"
    for column, title in zip(axes.T, titles, strict=True):
        for ax, is_log in zip(column, (False, True), strict=True):
            _draw(ax, results, size, resampling.VIEWS[title])
            if is_log:
                log_errors(ax)
        column[0].set(title=title, ylim=(0, None))
        column[1].set(xlabel="frame")
    for ax in axes[:, 0]:
        ax.set(ylabel="error of the centre, px")
    legend_of(figure, axes.flat)
    return figure


def _draw(axes: Axes, results: ex.Results, size: ex.Size, view: resampling.View) -> None:
    shade_occlusions(axes, resampling.run_scores(results, view, view.conventional, size.seeds[0]))
    for system, style in zip(reversed(view.pair), LINE_STYLES, strict=False):
        runs = [resampling.run_scores(results, view, system, seed) for seed in size.seeds]
        draw_band(axes, runs, style, system.variant)


def _claims(errors: dict[str, Errors]) -> tuple[ex.Claim, ...]:
    return (
        ex.Claim(
            "before the occlusion both filters follow the vehicle",
            f"{_PLACE}, case I",
            tuple(
                _both_low(interpretation, by_filter, "before")
                for interpretation, by_filter in errors.items()
            ),
            f"yes: both medians are below {_LOW:g} px; partly: one is",
        ),
        ex.Claim(
            "while it is partly hidden both have almost the same, low error",
            f"{_PLACE}, case II",
            tuple(
                _alike(interpretation, by_filter) for interpretation, by_filter in errors.items()
            ),
            f"yes: the medians are within a factor of {_ALIKE:g} and below {_LOW:g} px; partly: "
            "within that factor",
        ),
        ex.Claim(
            "while it is hidden the conventional filter's error is much higher than the adaptive "
            "one's",
            f"{_PLACE}, case III",
            tuple(
                _worse(interpretation, by_filter, "full")
                for interpretation, by_filter in errors.items()
            ),
            f"yes: its median is at least {_HIGHER:g} times the adaptive one's; partly: above "
            f"{_ALIKE:g} times",
        ),
        ex.Claim(
            "after the occlusion the adaptive filter has the vehicle again, the conventional one "
            "has lost it",
            f"{_PLACE}, case IV",
            tuple(_lost(interpretation, by_filter) for interpretation, by_filter in errors.items()),
            f"yes: below {_LOW:g} px in 80 % of the adaptive one's runs, and in at most 20 % of "
            "the other's; partly: in more of its runs",
        ),
        ex.Claim(
            f"(not in the paper in numbers) the adaptive filter's median RMSE is at most "
            f"{_AT_MOST:g} times the conventional one's",
            _PLACE,
            tuple(
                _no_worse(interpretation, by_filter) for interpretation, by_filter in errors.items()
            ),
            f"yes: it is; partly: at most {_ALIKE:g} times",
        ),
    )


def _numbers_text(by_filter: Errors, phase: str) -> str:
    return ", ".join(
        f"{variant} {median_and_range(by_phase[phase])} px"
        for variant, by_phase in by_filter.items()
    )


def _medians(by_filter: Errors, phase: str) -> tuple[float, float]:
    """Median RMSE of the conventional and of the adaptive filter in a phase, px."""
    return (
        median(by_filter[resampling.CONVENTIONAL][phase]),
        median(by_filter[resampling.ADAPTIVE][phase]),
    )


def _both_low(interpretation: str, by_filter: Errors, phase: str) -> ex.Finding:
    low = [value < _LOW for value in _medians(by_filter, phase)]
    return ex.Finding(
        interpretation, ex.Holds.of(all(low), any(low)), _numbers_text(by_filter, phase)
    )


def _alike(interpretation: str, by_filter: Errors) -> ex.Finding:
    pair = _medians(by_filter, "partial")
    alike = max(pair) <= _ALIKE * min(pair)
    return ex.Finding(
        interpretation,
        ex.Holds.of(alike and max(pair) < _LOW, alike),
        _numbers_text(by_filter, "partial"),
    )


def _worse(interpretation: str, by_filter: Errors, phase: str) -> ex.Finding:
    conventional, adaptive = _medians(by_filter, phase)
    return ex.Finding(
        interpretation,
        ex.Holds.of(conventional >= _HIGHER * adaptive, conventional > _ALIKE * adaptive),
        _numbers_text(by_filter, phase),
    )


def _lost(interpretation: str, by_filter: Errors) -> ex.Finding:
    back = {
        variant: [value < _LOW for value in by_phase["after"]]
        for variant, by_phase in by_filter.items()
    }
    ours, others = (sum(back[s]) for s in (resampling.ADAPTIVE, resampling.CONVENTIONAL))
    runs = len(back[resampling.ADAPTIVE])
    return ex.Finding(
        interpretation,
        ex.Holds.of(ours >= 0.8 * runs and others <= 0.2 * runs, ours > others),
        f"{_numbers_text(by_filter, 'after')}; below {_LOW:g} px in {ours} of {runs} runs of "
        f"adaptive and {others} of conventional",
    )


def _no_worse(interpretation: str, by_filter: Errors) -> ex.Finding:
    conventional, adaptive = _medians(by_filter, "all")
    return ex.Finding(
        interpretation,
        ex.Holds.of(adaptive <= _AT_MOST * conventional, adaptive <= _ALIKE * conventional),
        f"{_numbers_text(by_filter, 'all')}: {adaptive / conventional:.2f} times",
    )


EXPERIMENT = ex.Experiment(
    "resampling-fig4", "Adaptive resampling, figure 4: the error in the four phases",
    resampling.cells, report,
)  # fmt: skip
