"""Tables II and III of the second paper as table and picture: percent by case and filter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from vehicle_pf_tracker.evaluation.experiments.case_figure import (
    GROUND_TOLD,
    SHADES,
    Values,
    draw_cases,
)
from vehicle_pf_tracker.evaluation.experiments.data_table import DataTable
from vehicle_pf_tracker.evaluation.experiments.mfpf_systems import OURS
from vehicle_pf_tracker.evaluation.experiments.numbers import mean_and_spread
from vehicle_pf_tracker.scenes.cases import CASES


def share_table(shares: Mapping[str, Values], paper: Mapping[str, Sequence[float]]) -> DataTable:
    """Put every reading's percentages, and the paper's for its six cases, below each other."""
    cases = list(next(iter(shares.values())))
    rows = [
        (f"{label}{'' if reading == OURS else ', ' + reading}",
         *(mean_and_spread(of_case[label]) for of_case in found.values()))
        for reading, found in shares.items()
        for label in paper
    ]  # fmt: skip
    rows += [
        (f"{label} in the paper", *(f"{values[int(case[-1]) - 1]:.1f}" for case in cases))
        for label, values in paper.items()
    ]
    return DataTable(("", *cases), tuple(rows))


def share_figure(found: Values, what: str) -> Figure:
    """Draw percentages by case; `what` they are of stands at the axis."""
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    axes = figure.add_subplot()
    draw_cases(axes, found, {case: SHADES[CASES[case].occlusion] for case in found})
    axes.set_xticks(range(len(found)), [case.removeprefix("case") for case in found])
    axes.set(ylim=(-3, 103), ylabel=what, xlabel=f"case {GROUND_TOLD}")
    figure.legend(loc="outside lower center", ncols=4, frameon=False)
    return figure
