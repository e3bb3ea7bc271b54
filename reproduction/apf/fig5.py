# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 5 of the first paper: the path over the scene, interpolated over the occlusions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf import video3
from reproduction.apf.systems import APF, INTERPRETATIONS
from reproduction.drawing.shading import OUTLINE
from reproduction.numbers import counted, median_and_range, share
from reproduction.runs.cells import Result, RunCell
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import Scores
from vehicle_pf_tracker.trackers.estimate import Mode

_Judge: TypeAlias = Callable[[str, Sequence[Result], Sequence[Scores]], ex.Finding]

_PLACE = "section IV, figure 5"
_RULE = "yes: in 80 % of these frames of every run; partly: in half of those of a run"
"""Rule of the two claims on the regimes."""
_EARLY = 3
"""Frame of the first picture: nothing hides the vehicle yet."""
_ROWS_AROUND = 60
"""Rows of the image shown above and below the vehicle's path."""


def cells(size: ex.Size) -> list[RunCell]:
    """Run every interpretation of the paper's tracker with every seed."""
    return [video3.cell(system, seed) for system in INTERPRETATIONS.values() for seed in size.seeds]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Show the first seed's path over four frames, and judge all seeds."""
    runs = {
        system.label: [video3.run_scores(results, system, seed) for seed in size.seeds]
        for system in INTERPRETATIONS.values()
    }
    return ex.Report(
        video3.data(runs, size),
        _figure(runs[APF.label][0], size.seeds[0]),
        _verdict(results, runs, size),
    )


def _figure(scored: Scores, seed: int) -> Figure:
    sign, coach = _hidden_stretches(scored)
    shown = {
        _EARLY: "in the clear",
        sum(sign) // 2: "hidden by the sign",
        sum(coach) // 2: "hidden by the coach",
        len(scored.frames): "in the clear again",
    }
    frames = _frames(set(shown), seed)
    figure = Figure(figsize=(7, 8), layout="constrained")
    for ax, (number, what) in zip(figure.subplots(4, 1, sharex=True), shown.items(), strict=True):
        _draw(ax, frames[number], scored, number)
        ax.set_title(f"frame {number}, {what}", fontsize="medium")
        ax.set(ylabel="y, px")
    ax.set(xlabel="x, px")
    handles, labels = ax.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    return figure


def _hidden_stretches(scored: Scores) -> list[tuple[int, int]]:
    """Return the first and the last frame of each total occlusion."""
    return [(o.first_frame, o.last_frame) for o in measure(scored).occlusions]


def _frames(numbers: set[int], seed: int) -> dict[int, Frame]:
    """Render the frames of these numbers."""
    shown = enumerate(video3.SCENE.seeded(seed).make().frames(), start=1)
    return {number: scene_frame.frame for number, scene_frame in shown if number in numbers}


def _draw(axes: Axes, frame: Frame, scored: Scores, until: int) -> None:
    """Draw the path up to a frame: the estimates dotted, with the interpolated path solid."""
    height, width = frame.shape[:2]
    # In grey, so that the paths stand out.
    axes.imshow(frame.mean(axis=2), cmap="gray", vmin=0, vmax=255, extent=(0, width, height, 0))
    rows = [f.row for f in scored.frames[:until]]
    path = [row.position for row in rows if row.position is not None]
    line = [row.position for row in rows if row.mode == Mode.TRACKING and row.position is not None]
    # Black on white and white on black, so that both are seen on any ground.
    axes.plot(*zip(*line, strict=True), color="white", lw=3.6)
    axes.plot(
        *zip(*line, strict=True), color="#0072B2", lw=1.8, label="interpolated while not TRACKING"
    )
    axes.plot(
        *zip(*path, strict=True),
        ls=(0, (1, 1)),
        color="#E69F00",
        lw=2.0,
        path_effects=OUTLINE,
        label="estimates",
    )
    axes.plot(
        *zip(path[0], path[-1], strict=True),
        ls="",
        marker="+",
        ms=16,
        mew=2.4,
        color="black",
        path_effects=OUTLINE,
        label="first and last position",
    )
    rows_of_path = [f.truth.box.centre[1] for f in scored.frames if f.truth is not None]
    axes.set(
        xlim=(0, width), ylim=(max(rows_of_path) + _ROWS_AROUND, min(rows_of_path) - _ROWS_AROUND)
    )


def _verdict(
    results: ex.Results, runs: dict[str, list[Scores]], size: ex.Size
) -> ex.ExperimentVerdict:
    def claim(words: str, judge: _Judge, rule: str) -> ex.Claim:
        findings = []
        for interpretation, system in INTERPRETATIONS.items():
            raw = [results[video3.cell(system, seed)] for seed in size.seeds]
            findings.append(judge(interpretation, raw, runs[system.label]))
        return ex.Claim(words, _PLACE, tuple(findings), rule)

    def followed(name: str, raw: Sequence[Result], scored: Sequence[Scores]) -> ex.Finding:
        return _followed(
            name, video3.recoveries(scored), [run["metrics"]["rmse_px"] for run in raw]
        )

    def in_regime(occlusion: Occlusion, regime: str, sentence: str) -> _Judge:
        return lambda name, raw, scored: _by_share(
            name,
            [_share_in(*pair, occlusion, regime) for pair in zip(raw, scored, strict=True)],
            sentence,
        )

    clear = in_regime(Occlusion.NONE, "regular", "regular in {} % of the clear frames")
    hidden = in_regime(Occlusion.TOTAL, "occlusion", "occlusion mode in {} % of the hidden frames")
    return ex.ExperimentVerdict(
        (
            claim(
                "the vehicle is followed through partial and total occlusions",
                followed,
                "yes: 95 % of the total occlusions are recovered from; partly: a quarter",
            ),
            claim("in the clear, the regular mode is used", clear, _RULE),
            claim("occlusion mode is entered during total occlusions", hidden, _RULE),
        ),
        f"{video3.SETTING} {len(size.seeds)} seeds; the picture shows the first.",
    )


def _followed(interpretation: str, hits: Sequence[bool], rmse: Sequence[float]) -> ex.Finding:
    return ex.Finding(
        interpretation,
        ex.Holds.share(share(hits), partly=0.25),
        f"{counted(hits)} total occlusions recovered from; RMSE {median_and_range(rmse)} px",
    )


def _by_share(interpretation: str, shares: Sequence[float], sentence: str) -> ex.Finding:
    least = min(shares)
    numbers = sentence.format(median_and_range([100 * value for value in shares], 0))
    return ex.Finding(interpretation, ex.Holds.of(least >= 0.8, max(shares) >= 0.5), numbers)


def _share_in(run: Result, scored: Scores, occlusion: Occlusion, regime: str) -> float:
    regimes = run["trace"]["regime"]
    hits = [
        regimes[index] == regime
        for index, frame in enumerate(scored.frames)
        if index > 0 and frame.truth is not None and frame.truth.occlusion is occlusion
    ]
    return share(hits)


EXPERIMENT = ex.Experiment(
    "apf-fig5", "APF, figure 5: the path over the scene, interpolated over the occlusions", cells,
    report,
)  # fmt: skip
