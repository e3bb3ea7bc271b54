# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 4 of the first paper: both similarities and the threshold, for bars of 1 and 30 px."""

from __future__ import annotations

from collections.abc import Sequence

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
from reproduction.numbers import counted, median_and_range, share
from reproduction.runs.cells import Result, RunCell

_WIDTHS = 1, 30
"""Widths of the bar in the paper's figure, px."""
_TAU = 0.8
"""Threshold that the paper draws into it."""
_PLACE = "section IV, figure 4"
_RECORD = ("pi", "pi_up", "regime")
_SHOWN = {"pi": "Pi", "pi_up": "Pi_up"}
_LINES = {1: ((0, (1, 1.2)), "#D55E00"), 30: ("-", "#0072B2")}
_ALL = slice(None)
_SLACK = 3
"""Frames before and after the covered ones in which an occlusion may be noticed."""


def cells(size: ex.Size) -> list[RunCell]:
    """Run every interpretation on both widths with every seed."""
    return [
        _cell(interpretation, width, seed)
        for width in _WIDTHS
        for interpretation in INTERPRETATIONS
        for seed in size.seeds
    ]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the first seed's similarities, and judge all seeds."""
    rows: list[tuple[ex.Entry, ...]] = []
    for interpretation in INTERPRETATIONS:
        for width in _WIDTHS:
            for seed in size.seeds:
                trace = results[_cell(interpretation, width, seed)]["trace"]
                columns = zip(trace["pi"], trace["pi_up"], trace["regime"], strict=True)
                rows += [
                    (interpretation, width, seed, frame, *values)
                    for frame, values in enumerate(columns, start=1)
                ]
    names = ("interpretation", "width", "seed", "frame", "pi", "pi_up", "regime")
    return ex.Report(
        ex.DataTable(names, tuple(rows)), _figure(results, size), _verdict(results, size)
    )


def _cell(interpretation: str, width: int, seed: int) -> RunCell:
    system = with_sigma(INTERPRETATIONS[interpretation], VEHICLE_SPEED)
    return RunCell(artificial_video(width), system, seed, _RECORD)


def _figure(results: ex.Results, size: ex.Size) -> Figure:
    figure = Figure(figsize=(11, 5.2), layout="constrained")
    axes = figure.subplots(2, len(INTERPRETATIONS), sharex=True, sharey=True)
    for column, interpretation in enumerate(INTERPRETATIONS):
        for row, (scalar, name) in enumerate(_SHOWN.items()):
            traces = {
                width: results[_cell(interpretation, width, size.seeds[0])]["trace"][scalar]
                for width in _WIDTHS
            }
            _draw(axes[row, column], traces)
            axes[row, 0].set(ylabel=name)
        axes[0, column].set(title=interpretation)
        axes[1, column].set(xlabel="frame")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    return figure


def _draw(axes: Axes, traces: dict[int, list[float | None]]) -> None:
    span = covered(artificial_video(_WIDTHS[-1]).truths())
    assert span is not None
    axes.axvspan(*span, color="0.9", lw=0, label=f"{_WIDTHS[-1]} px bar covers a part or all")
    for width, trace in traces.items():
        style, colour = _LINES[width]
        # The first frame has no similarity yet: it is the reference.
        axes.plot(
            range(2, len(trace) + 1),
            [value or 0.0 for value in trace[1:]],
            ls=style,
            color=colour,
            lw=1.6,
            label=f"width {width} px",
        )
    axes.axhline(_TAU, color="black", ls="--", lw=1.0, label=f"tau = {_TAU:g}")
    axes.set_ylim(0, 1)


def _verdict(results: ex.Results, size: ex.Size) -> ex.ExperimentVerdict:
    def runs(interpretation: str, width: int) -> list[Result]:
        return [results[_cell(interpretation, width, seed)] for seed in size.seeds]

    narrow, wide = _WIDTHS
    return ex.ExperimentVerdict(
        (
            ex.Claim(
                f"with {narrow} px the similarities stay above the threshold, and occlusion mode "
                "is not entered",
                _PLACE,
                tuple(
                    _ignored(interpretation, runs(interpretation, narrow))
                    for interpretation in INTERPRETATIONS
                ),
                "yes: Pi and Pi_up are at least 0.8 in every frame of every run, and none is in "
                "occlusion mode; partly: none is at the bar",
            ),
            ex.Claim(
                f"with {wide} px the similarities fall below the threshold, and the occlusion is "
                "detected",
                _PLACE,
                tuple(
                    _detected(interpretation, runs(interpretation, wide))
                    for interpretation in INTERPRETATIONS
                ),
                "yes: in 95 % of the runs Pi or Pi_up falls below 0.8 at the bar, and occlusion "
                "mode begins there and not before; partly: in half",
            ),
        ),
        f"{BAR_SETTING} It passes at {VEHICLE_SPEED:g} px/frame, sigma is the same number; "
        f"{len(size.seeds)} seeds. Curves are those of the first seed. "
        f"{INTERPRETATIONS_NOTE}",
    )


def _ignored(interpretation: str, runs: Sequence[Result]) -> ex.Finding:
    least = [_least(run, "pi") for run in runs]
    least_up = [_least(run, "pi_up") for run in runs]
    never = [sum(_occluded(run)) == 0 for run in runs]
    above = [min(pair) >= _TAU for pair in zip(least, least_up, strict=True)]
    near_bar = _span(_WIDTHS[0])
    caused = [any(_occluded(run)[near_bar]) for run in runs]
    frames = [sum(_occluded(run)) for run in runs]
    return ex.Finding(
        interpretation,
        ex.Holds.of(all(never) and all(above), not any(caused)),
        f"least Pi {median_and_range(least, 2)}, least Pi_up {median_and_range(least_up, 2)}; "
        f"above {_TAU:g} throughout in {counted(above)} runs; {median_and_range(frames, 0)} "
        f"frames in occlusion mode, none in {counted(never)} runs; at the bar in {counted(caused)}",
    )


def _detected(interpretation: str, runs: Sequence[Result]) -> ex.Finding:
    least, least_up = ([_least(run, name) for run in runs] for name in _SHOWN)
    span = _span(_WIDTHS[-1])
    fell = [min(_least(run, name, span) for name in _SHOWN) < _TAU for run in runs]
    entered = [any(_occluded(run)[span]) for run in runs]
    before = [sum(_occluded(run)[: span.start]) for run in runs]
    # Occlusion mode that begins without the bar does not detect it.
    hits = [
        fall and enter and frames == 0
        for fall, enter, frames in zip(fell, entered, before, strict=True)
    ]
    return ex.Finding(
        interpretation,
        ex.Holds.share(share(hits)),
        f"least Pi {median_and_range(least, 2)}, least Pi_up {median_and_range(least_up, 2)}; "
        f"occlusion mode at the bar in {counted(entered)} runs, before it in "
        f"{median_and_range(before, 0)} frames",
    )


def _least(run: Result, scalar: str, frames: slice = _ALL) -> float:
    values: list[float | None] = run["trace"][scalar][frames]
    return min(value for value in values if value is not None)


def _occluded(run: Result) -> list[bool]:
    return [regime == "occlusion" for regime in run["trace"]["regime"]]


def _span(width: int) -> slice:
    """Return the indices of the frames in which the bar covers the vehicle, and a few around."""
    hidden = covered(artificial_video(width).truths())
    assert hidden is not None
    return slice(hidden[0] - 1 - _SLACK, hidden[1] + _SLACK)


EXPERIMENT = ex.Experiment(
    "apf-fig4", "APF, figure 4: Pi and Pi_up with occlusions of 1 and 30 px", cells, report
)
