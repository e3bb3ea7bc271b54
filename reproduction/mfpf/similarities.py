# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures 5a to 15a of the second paper: average similarities and their thresholds, per frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.drawing.shading import shade_occlusions
from reproduction.mfpf import systems as mfpf
from reproduction.mfpf.case_plots import draw_by_case
from reproduction.mfpf.systems import FEATURE_NAMES, INTERPRETATIONS, MFPF
from reproduction.numbers import counted, mean_and_spread, share
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES

_PLACE = "section V, figures 5a to 15a"
_RECOVERING = "case4", "case5"
"""Cases of which the paper says that the edge feature recovers first."""
_LAST_PHASE = 0.2
"""Share of the frames that the last phase of case 1 has in figure 5a."""
_SOON = 10
"""Frames in which a feature that becomes acceptable again has to be in use: as many as the filter
searches wider after the start."""
_NOT_RUN = "case1 was not run"
"""Result of claims on case 1 in a quick run, which leaves it out."""


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the first seed's similarities, and judge all seeds."""
    rows: list[tuple[ex.Entry, ...]] = []
    for interpretation in INTERPRETATIONS:
        for case in mfpf.cases(size):
            for seed in size.seeds:
                rows += _rows(results, case, seed, interpretation)
    columns = ("interpretation", "case", "seed", "frame",
               *(f"{value}_{name}" for value in ("as", "used") for name in FEATURE_NAMES),
               "regime")  # fmt: skip
    return ex.Report(
        ex.DataTable(columns, tuple(rows)),
        _figure(results, size),
        ex.ExperimentVerdict(
            _claims(results, size),
            f"{mfpf.setting(size)} Curves are those of the first seed under the paper's "
            "rule; thin level lines in the style of a curve are its threshold. Marks at the foot "
            "of each plot are frames in prediction mode.",
        ),
    )


def _rows(
    results: ex.Results, case: str, seed: int, interpretation: str
) -> list[tuple[ex.Entry, ...]]:
    trace = mfpf.trace(results, case, MFPF, seed, interpretation)
    names = [f"{value}_{name}" for value in ("as", "used") for name in FEATURE_NAMES]
    columns = zip(*(trace[name] for name in names), trace["regime"], strict=True)
    return [
        (interpretation, case, seed, frame, *values)
        for frame, values in enumerate(columns, start=1)
        if values[0] is not None
    ]


def _figure(results: ex.Results, size: ex.Size) -> Figure:
    def draw(axes: Axes, case: str) -> None:
        _draw(axes, results, case, size.seeds[0])

    return draw_by_case(size, draw, "average similarity", height=2.7, one_scale=True)


def _draw(axes: Axes, results: ex.Results, case: str, seed: int) -> None:
    scored = mfpf.run_scores(results, case, MFPF, seed)
    shade_occlusions(axes, scored)
    trace = mfpf.trace(results, case, MFPF, seed)
    for (name, label), style in zip(FEATURE_NAMES.items(), LINE_STYLES, strict=False):
        values = trace[f"as_{name}"][1:]
        frames = range(2, len(values) + 2)
        axes.plot(frames, values, color=style.colour, ls=style.line, lw=1.5, label=label)
        limit = mfpf.threshold(ex.PAPER_RULE) * values[0]
        axes.axhline(limit, color=style.colour, ls=style.line, lw=0.8)
    predicted = [n for n, r in enumerate(trace["regime"], start=1) if r == "prediction"]
    axes.plot(
        predicted,
        [0.03] * len(predicted),
        ls="",
        marker="|",
        color="black",
        ms=7,
        label="prediction mode",
    )
    axes.set(ylim=(0, 1.02))
    axes.margins(x=0.01)


def _claims(results: ex.Results, size: ex.Size) -> tuple[ex.Claim, ...]:
    return (
        ex.Claim(
            "in cases 2 and 3 (a long partial occlusion, shadows) all features stay above their "
            "thresholds",
            "section V-B and V-C, figures 7a and 9a",
            tuple(
                _stays(
                    interpretation,
                    {
                        case: _used(results, size, case, interpretation)
                        for case in ("case2", "case3")
                        if case in mfpf.cases(size)
                    },
                )
                for interpretation in INTERPRETATIONS
            ),
            "yes: each is in use in 95 % of the frames of both (mean); partly: in half of them",
        ),
        ex.Claim(
            "of the three, RGB loses the most under the trees of case 1",
            "section V-A, figure 5a",
            tuple(
                _lowest(interpretation, _losses(results, size, interpretation))
                for interpretation in INTERPRETATIONS
            ),
            "yes: its mean loss of average similarity is the largest; partly: the second",
        ),
        ex.Claim(
            "RGB is excluded in the last phase of case 1, edge and texture are not",
            "section V-A, figure 5a",
            tuple(
                _excluded(interpretation, _last_phase(results, size, interpretation))
                for interpretation in INTERPRETATIONS
            ),
            f"yes: RGB alone is out of use in frames of the last {_LAST_PHASE:.0%} of 80 % of the "
            "runs; partly: of 20 %",
        ),
        ex.Claim(
            "the edge feature is the first to recover after the full occlusions of cases 4 and 5",
            "section V-D and V-E, figures 11a and 13a",
            tuple(
                _first_back(interpretation, _all_back(results, size, interpretation))
                for interpretation in INTERPRETATIONS
            ),
            "yes: it is among the first in 80 % of the runs that end an occlusion in prediction "
            "mode; partly: most often of the three",
        ),
        ex.Claim(
            "when the occlusion of case 6 has vanished, RGB and texture become acceptable",
            "section V-F, figure 15a",
            tuple(
                _acceptable(interpretation, _accepted(results, size, interpretation))
                for interpretation in INTERPRETATIONS
            ),
            f"yes: both are in use within {_SOON} frames in 80 % of the runs; partly: one is",
        ),
    )


def _used(
    results: ex.Results, size: ex.Size, case: str, interpretation: str
) -> Mapping[str, Sequence[float]]:
    """Share of the frames in which a feature is in use, for each seed."""
    return {
        name: [
            fmean(mfpf.trace(results, case, MFPF, seed, interpretation)[f"used_{name}"][1:])
            for seed in size.seeds
        ]
        for name in FEATURE_NAMES
    }


def _stays(interpretation: str, by_case: Mapping[str, Mapping[str, Sequence[float]]]) -> ex.Finding:
    """Judge the share of the frames in which each feature is in use, by case."""
    parts = []
    least = []
    for case, used in by_case.items():
        least.append(min(fmean(values) for values in used.values()))
        parts.append(
            f"{case}: "
            + ", ".join(
                f"{FEATURE_NAMES[name]} {mean_and_spread([100 * v for v in values], 0)}"
                for name, values in used.items()
            )
        )
    return ex.Finding(
        interpretation,
        ex.Holds.of(min(least) >= 0.95, min(least) >= 0.5),
        f"percent of the frames in use, {'; '.join(parts)}",
    )


def _losses(
    results: ex.Results, size: ex.Size, interpretation: str
) -> Mapping[str, Sequence[float]]:
    """Largest loss of each feature's average similarity in case 1, for each seed."""
    losses: dict[str, list[float]] = {name: [] for name in FEATURE_NAMES}
    if "case1" not in mfpf.cases(size):
        return losses
    for seed in size.seeds:
        trace = mfpf.trace(results, "case1", MFPF, seed, interpretation)
        for name in FEATURE_NAMES:
            values = trace[f"as_{name}"][1:]
            losses[name].append(1 - min(values) / values[0])
    return losses


def _lowest(interpretation: str, losses: Mapping[str, Sequence[float]]) -> ex.Finding:
    if not losses["color"]:
        return ex.Finding(interpretation, ex.Holds.NO, _NOT_RUN)
    means = {name: fmean(values) for name, values in losses.items()}
    parts = ", ".join(
        f"{FEATURE_NAMES[name]} {mean_and_spread([100 * v for v in values], 0)} %"
        for name, values in losses.items()
    )
    place = sorted(means, key=lambda name: -means[name]).index("color")
    return ex.Finding(
        interpretation,
        ex.Holds.of(place == 0, place == 1),
        f"largest loss of the average similarity: {parts}",
    )


def _last_phase(
    results: ex.Results, size: ex.Size, interpretation: str
) -> Sequence[tuple[float, float, float]]:
    """Share of the frames of case 1's last phase with each feature out of use, for each seed."""
    unused = []
    for seed in size.seeds if "case1" in mfpf.cases(size) else ():
        trace = mfpf.trace(results, "case1", MFPF, seed, interpretation)
        count = round(_LAST_PHASE * len(trace["regime"]))
        color, edge, texture = (
            1 - fmean(trace[f"used_{name}"][-count:]) for name in ("color", "edge", "texture")
        )
        unused.append((color, edge, texture))
    return unused


def _excluded(interpretation: str, unused: Sequence[tuple[float, float, float]]) -> ex.Finding:
    if not unused:
        return ex.Finding(interpretation, ex.Holds.NO, _NOT_RUN)
    hits = [color > 0 and edge == texture == 0 for color, edge, texture in unused]
    parts = ", ".join(
        f"{label} {mean_and_spread([100 * seed[number] for seed in unused], 0)} %"
        for number, label in enumerate(FEATURE_NAMES.values())
    )
    return ex.Finding(
        interpretation,
        ex.Holds.of(share(hits) >= 0.8, share(hits) >= 0.2),
        f"RGB alone in {counted(hits)} runs; out of use in that phase: {parts}",
    )


def _accepted(
    results: ex.Results, size: ex.Size, interpretation: str
) -> Sequence[tuple[bool, bool]]:
    """Tell for each seed whether RGB and texture are in use soon after case 6's occlusion."""
    in_use = []
    for seed in size.seeds:
        trace = mfpf.trace(results, "case6", MFPF, seed, interpretation)
        frames = mfpf.run_scores(results, "case6", MFPF, seed, interpretation).frames
        last = max(index for index, frame in enumerate(frames) if frame.hidden)
        soon = slice(last + 1, last + 1 + _SOON)
        color, texture = (any(trace[f"used_{name}"][soon]) for name in ("color", "texture"))
        in_use.append((color, texture))
    return in_use


def _acceptable(interpretation: str, in_use: Sequence[tuple[bool, bool]]) -> ex.Finding:
    color, texture = ([pair[number] for pair in in_use] for number in (0, 1))
    enough = [share(hits) >= 0.8 for hits in (color, texture)]
    both = share([all(pair) for pair in in_use]) >= 0.8
    return ex.Finding(
        interpretation,
        ex.Holds.of(both, any(enough)),
        f"in use within {_SOON} frames: RGB in {counted(color)} runs, texture in "
        f"{counted(texture)}",
    )


def _all_back(results: ex.Results, size: ex.Size, interpretation: str) -> Sequence[Sequence[str]]:
    """Name the features that were back first, for each run that was in prediction mode."""
    of_runs = (
        _back(results, case, seed, interpretation)
        for case in _RECOVERING
        if case in mfpf.cases(size)
        for seed in size.seeds
    )
    return [names for names in of_runs if names is not None]


def _first_back(interpretation: str, back: Sequence[Sequence[str]]) -> ex.Finding:
    firsts = [name for names in back for name in names]
    judged = len(back)
    parts = ", ".join(f"{label} {firsts.count(name)}" for name, label in FEATURE_NAMES.items())
    most = max(FEATURE_NAMES, key=firsts.count)
    return ex.Finding(
        interpretation,
        ex.Holds.of(
            judged > 0 and most == "edge" and firsts.count("edge") >= 0.8 * judged,
            judged > 0 and most == "edge",
        ),
        f"first after prediction mode, of {judged} runs that were in it at the end of a full "
        f"occlusion: {parts} (some at once)",
    )


def _back(results: ex.Results, case: str, seed: int, interpretation: str) -> list[str] | None:
    """Name the features in use in the first frame after prediction mode; None if it was not on."""
    trace = mfpf.trace(results, case, MFPF, seed, interpretation)
    frames = mfpf.run_scores(results, case, MFPF, seed, interpretation).frames
    last = max(index for index, frame in enumerate(frames) if frame.hidden)
    if trace["regime"][last] != "prediction":
        return None
    for index in range(last, len(frames)):
        if trace["regime"][index] == "estimation":
            return [name for name in FEATURE_NAMES if trace[f"used_{name}"][index]]
    return []


EXPERIMENT = ex.Experiment(
    "mfpf-similarities", "MFPF, figures 5a to 15a: average similarities and their thresholds",
    mfpf.cells, report,
)  # fmt: skip
