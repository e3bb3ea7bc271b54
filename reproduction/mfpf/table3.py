# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Table III of the second paper: how often the error is below 15 px."""

from __future__ import annotations

from collections.abc import Mapping
from statistics import fmean

from reproduction.drawing.case_figure import Values
from reproduction.experiment import Claim, Experiment, Finding, Holds, Report, Results, Size
from reproduction.mfpf import systems as mfpf
from reproduction.mfpf.share import ShareWords, share_report
from reproduction.numbers import mean_and_spread, share
from vehicle_pf_tracker.evaluation.scores import CLOSE_PX

_PLACE = "section V, table III"
# The paper's percentages of cases 1 to 6.
_PAPER = {
    "RGB": (6.9, 63.4, 58.6, 96.3, 18.1, 70.7),
    "Edge": (67.4, 78.0, 34.4, 70.3, 31.8, 76.9),
    "Texture": (23.2, 78.0, 62.0, 66.6, 59.0, 72.3),
    "MFPF": (62.7, 100.0, 62.0, 96.3, 72.7, 84.6),
}


_OFTEN = 0.8
"""Share of the seeds that a mean has to be carried by."""


def report(results: Results, size: Size) -> Report:
    """Take the shares, and judge them."""
    shares = {
        interpretation: _shares(results, size, interpretation) for interpretation in mfpf.RIVALRIES
    }
    words = ShareWords(
        f"Percent of the frames with an error below {CLOSE_PX:g} px, mean ± standard deviation "
        "over the seeds:",
        of="filter",
        column="percent_below_15px",
        axis=f"errors below {CLOSE_PX:g} px, %",
    )
    return share_report(shares, _PAPER, size, words, _claims(shares))


def _shares(results: Results, size: Size, interpretation: str) -> dict[str, dict[str, list[float]]]:
    return {
        case: {
            system.label: [
                100 * value
                for value in mfpf.per_seed(
                    results, size, case, system, interpretation, "p_error_lt_15px"
                )
            ]
            for system in mfpf.FOUR_SYSTEMS
        }
        for case in mfpf.cases(size)
    }


def _claims(shares: Mapping[str, Values]) -> tuple[Claim, ...]:
    return (
        Claim(
            "MFPF's error is below 15 px at least as often as any single-feature filter's (in the "
            "paper in five cases of six)",
            _PLACE,
            tuple(_first(interpretation, by_case) for interpretation, by_case in shares.items()),
            "yes: by the means, in all cases but one; partly: in one",
        ),
        Claim(
            "(taken together) over all cases MFPF's share is above the best single-feature "
            "filter's",
            _PLACE,
            tuple(_over_all(interpretation, by_case) for interpretation, by_case in shares.items()),
            "yes: its mean is above, and so it is with 80 % of the seeds; partly: one of the two",
        ),
    )


def _first(interpretation: str, by_case: Values) -> Finding:
    ahead = []
    parts = []
    for case, of_case in by_case.items():
        best = max((s.label for s in mfpf.SINGLE_FEATURES), key=lambda label: fmean(of_case[label]))
        own = fmean(of_case[mfpf.MFPF.label])
        ahead.append(own >= fmean(of_case[best]))
        parts.append(f"{case} {own:.0f} % ({best} {fmean(of_case[best]):.0f} %)")
    return Finding(
        interpretation,
        Holds.of(sum(ahead) >= len(ahead) - 1, any(ahead)),
        f"ahead or level in {sum(ahead)} of {len(ahead)} cases: {', '.join(parts)}",
    )


def _over_all(interpretation: str, by_case: Values) -> Finding:
    means = {
        system.label: [
            fmean(of) for of in zip(*(c[system.label] for c in by_case.values()), strict=True)
        ]
        for system in mfpf.FOUR_SYSTEMS
    }
    best = max((s.label for s in mfpf.SINGLE_FEATURES), key=lambda label: fmean(means[label]))
    own = means[mfpf.MFPF.label]
    is_above = fmean(own) > fmean(means[best])
    is_often = share([a > b for a, b in zip(own, means[best], strict=True)]) >= _OFTEN
    return Finding(
        interpretation,
        Holds.of(is_above and is_often, is_above or is_often),
        f"{mean_and_spread(means[mfpf.MFPF.label])} % against {mean_and_spread(means[best])} % of "
        f"{best}",
    )


EXPERIMENT = Experiment(
    "mfpf-table3", "MFPF, table III: how often the error is below 15 px", mfpf.cells, report
)
