# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures 5a to 15a of the second paper: average similarities and their thresholds, per frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction import mfpf_systems as mfpf
from reproduction.mfpf_case_plots import draw_by_case
from reproduction.mfpf_systems import FEATURES, INTERPRETATIONS, MFPF
from reproduction.numbers import mean_and_spread
from reproduction.shading import shade_occlusions
from vehicle_pf_tracker.evaluation.plots import STYLES

_PLACE = "section V, figures 5a to 15a"


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the first seed's similarities, and judge all seeds."""
    rows: list[tuple[ex.Entry, ...]] = []
    for interpretation in INTERPRETATIONS:
        for case in mfpf.cases(size):
            for seed in size.seeds:
                rows += _rows(results, case, seed, interpretation)
    columns = ("interpretation", "case", "seed", "frame",
               *(f"{value}_{name}" for value in ("as", "used") for name in FEATURES),
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
    names = [f"{value}_{name}" for value in ("as", "used") for name in FEATURES]
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
    for (name, label), style in zip(FEATURES.items(), STYLES, strict=False):
        values = trace[f"as_{name}"][1:]
        frames = range(2, len(values) + 2)
        axes.plot(frames, values, color=style.colour, ls=style.line, lw=1.5, label=label)
        limit = mfpf.threshold(ex.PAPER) * values[0]
        axes.axhline(limit, color=style.colour, ls=style.line, lw=0.8)
    predicted = [n for n, r in enumerate(trace["regime"], start=1) if r == "prediction"]
    axes.plot(predicted, [0.03] * len(predicted), ls="", marker="|", color="black", ms=7,
              label="prediction mode")  # fmt: skip
    axes.set(ylim=(0, 1.02))
    axes.margins(x=0.01)


def _claims(results: ex.Results, size: ex.Size) -> tuple[ex.Claim, ...]:
    return (
        ex.Claim(
            "in cases 2 and 3 (a long partial occlusion, shadows) all features stay above their "
            "thresholds",
            "section V-B and V-C, figures 7a and 9a",
            tuple(_stays(results, size, interpretation) for interpretation in INTERPRETATIONS),
        ),
        ex.Claim(
            "of the three, RGB loses the most under the trees of case 1",
            "section V-A, figure 5a",
            tuple(
                _lowest(results, size, interpretation, "case1", "color")
                for interpretation in INTERPRETATIONS
            ),
        ),
        ex.Claim(
            "the edge feature is the first to recover after the full occlusions of cases 4 to 6",
            "section V-D and V-E, figures 11a and 13a",
            tuple(_first_back(results, size, interpretation) for interpretation in INTERPRETATIONS),
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
        for name in FEATURES
    }


def _stays(results: ex.Results, size: ex.Size, interpretation: str) -> ex.Finding:
    parts, least = [], []
    for case in ("case2", "case3"):
        if case not in mfpf.cases(size):
            continue
        used = _used(results, size, case, interpretation)
        least.append(min(fmean(values) for values in used.values()))
        parts.append(f"{case}: " + ", ".join(
            f"{FEATURES[name]} {mean_and_spread([100 * v for v in values], 0)}"
            for name, values in used.items()
        ))  # fmt: skip
    return ex.Finding(
        interpretation, ex.Holds.of(min(least) >= 0.95, min(least) >= 0.5),
        f"percent of the frames in use, {'; '.join(parts)}",
    )  # fmt: skip


def _lowest(
    results: ex.Results, size: ex.Size, interpretation: str, case: str, feature: str
) -> ex.Finding:
    if case not in mfpf.cases(size):
        return ex.Finding(interpretation, ex.Holds.NO, f"{case} was not run")
    losses = {name: [] for name in FEATURES}  # type: dict[str, list[float]]
    for seed in size.seeds:
        trace = mfpf.trace(results, case, MFPF, seed, interpretation)
        for name in FEATURES:
            values = trace[f"as_{name}"][1:]
            losses[name].append(1 - min(values) / values[0])
    means = {name: fmean(values) for name, values in losses.items()}
    parts = ", ".join(
        f"{FEATURES[name]} {mean_and_spread([100 * v for v in values], 0)} %"
        for name, values in losses.items()
    )
    return ex.Finding(
        interpretation, ex.Holds.of(means[feature] == max(means.values())),
        f"largest loss of the average similarity: {parts}",
    )  # fmt: skip


def _first_back(results: ex.Results, size: ex.Size, interpretation: str) -> ex.Finding:
    firsts: list[str] = []
    judged = 0
    for case in mfpf.FULLY_HIDDEN:
        if case not in mfpf.cases(size):
            continue
        for seed in size.seeds:
            found = _back(results, case, seed, interpretation)
            judged += found is not None
            firsts += found or []
    parts = ", ".join(f"{label} {firsts.count(name)}" for name, label in FEATURES.items())
    most = max(FEATURES, key=firsts.count)
    return ex.Finding(
        interpretation,
        ex.Holds.of(judged > 0 and most == "edge" and firsts.count("edge") >= 0.8 * judged,
                 judged > 0 and most == "edge"),
        f"first after prediction mode, of {judged} runs that were in it at the end of a full "
        f"occlusion: {parts} (some at once)",
    )  # fmt: skip


def _back(results: ex.Results, case: str, seed: int, interpretation: str) -> list[str] | None:
    """Name the features in use in the first frame after prediction mode; None if it was not on."""
    trace = mfpf.trace(results, case, MFPF, seed, interpretation)
    frames = mfpf.run_scores(results, case, MFPF, seed, interpretation).frames
    last = max(index for index, frame in enumerate(frames) if frame.hidden)
    if trace["regime"][last] != "prediction":
        return None
    for index in range(last, len(frames)):
        if trace["regime"][index] == "estimation":
            return [name for name in FEATURES if trace[f"used_{name}"][index]]
    return []


EXPERIMENT = ex.Experiment(
    "mfpf-similarities", "MFPF, figures 5a to 15a: average similarities and their thresholds",
    mfpf.cells, report,
)  # fmt: skip
