# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tables II and III of the second paper as table and picture: percent by case and filter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from reproduction.drawing.case_figure import (
    GROUND_NOTE,
    OCCLUSION_SHADES,
    Values,
    draw_cases,
)
from reproduction.experiment import (
    PAPER_RULE,
    Claim,
    DataTable,
    Entry,
    ExperimentVerdict,
    Report,
    Size,
)
from reproduction.mfpf import systems as mfpf
from reproduction.numbers import mean_and_spread
from reproduction.scenes.paper_scenes import CASE_SCENES


@dataclass(frozen=True, slots=True)
class ShareWords:
    """Names of the percentages: above the table, in the data's columns, at the axis."""

    title: str
    of: str
    column: str
    axis: str


def share_report(
    shares: Mapping[str, Values],
    paper: Mapping[str, Sequence[float]],
    size: Size,
    words: ShareWords,
    claims: Sequence[Claim],
) -> Report:
    """Table the percentages by interpretation, case and filter, and the paper's claims."""
    rows: list[tuple[Entry, ...]] = [
        (interpretation, case, label, seed, value)
        for interpretation, by_case in shares.items()
        for case, of_case in by_case.items()
        for label, values in of_case.items()
        for seed, value in zip(size.seeds, values, strict=True)
    ]
    return Report(
        DataTable(("interpretation", "case", words.of, "seed", words.column), tuple(rows)),
        _share_figure(shares[PAPER_RULE], words.axis),
        ExperimentVerdict(tuple(claims), mfpf.setting(size)),
        {words.title: _share_table(shares, paper)},
    )


def _share_table(shares: Mapping[str, Values], paper: Mapping[str, Sequence[float]]) -> DataTable:
    """Table every interpretation's percentages with the paper's for its six cases."""
    cases = list(next(iter(shares.values())))
    rows = [
        (
            mfpf.read_label(label, interpretation),
            *(mean_and_spread(of_case[label]) for of_case in by_case.values()),
        )
        for interpretation, by_case in shares.items()
        for label in paper
    ]
    rows += [
        (f"{label} in the paper", *(f"{values[int(case[-1]) - 1]:.1f}" for case in cases))
        for label, values in paper.items()
    ]
    return DataTable(("", *cases), tuple(rows))


def _share_figure(by_case: Values, what: str) -> Figure:
    """Draw percentages by case; `what` they are of stands at the axis."""
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    axes = figure.add_subplot()
    draw_cases(
        axes, by_case, {case: OCCLUSION_SHADES[CASE_SCENES[case].occlusion] for case in by_case}
    )
    axes.set_xticks(range(len(by_case)), [case.removeprefix("case") for case in by_case])
    axes.set(ylim=(-3, 103), ylabel=what, xlabel=f"case {GROUND_NOTE}")
    figure.legend(loc="outside lower center", ncols=4, frameon=False)
    return figure
