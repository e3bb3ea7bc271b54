# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Table I of the second paper: the RMS error of the four filters in six cases.

With it go the paper's claim on textures, and its assumption that the filter follows the vehicle to
the end.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean

from reproduction import experiment as ex
from reproduction.drawing.case_figure import OCCLUSION_SHADES, error_case_figure
from reproduction.mfpf import systems as mfpf
from reproduction.mfpf import textures
from reproduction.numbers import mean_and_spread, seed_means, share
from reproduction.runs.cells import RunCell, System
from reproduction.scenes.paper_scenes import CASE_SCENES
from vehicle_pf_tracker.evaluation.scores import CLOSE_PX

_PLACE = "section V, table I"
# The paper's RMS errors of cases 1 to 6, px.
_PAPER = {
    "RGB": (36.40, 13.50, 18.51, 11.23, 17.81, 14.52),
    "Edge": (17.61, 10.89, 24.01, 12.54, 21.02, 15.77),
    "Texture": (26.35, 11.95, 16.69, 13.66, 16.04, 13.50),
    "MFPF": (15.21, 8.38, 16.16, 9.97, 15.11, 11.93),
}
_REMARKS = (
    "MFPF falls behind a single feature because one feature is enough to keep it out of prediction "
    "mode. Beside a coach or under trees colour and texture drop out, but some window there has "
    "edges like the vehicle's. The edge feature alone then leads the particles away, while the RGB "
    "filter predicts. On real video MFPF is ahead: see mfpf in variants.md.",
)
_FOLLOWS = 0.8
"""Share of the runs that have to be followed: two of ten may be lost."""
_AT_LEAST = 0.10
"""The least saving that the paper speaks of."""

Errors = Mapping[str, Mapping[str, Sequence[float]]]
"""RMS of each seed, by case and by filter."""
Followed = Mapping[str, Mapping[str, Sequence[bool]]]
"""For each seed whether the run ends close to the vehicle, by case and by filter."""


def cells(size: ex.Size) -> list[RunCell]:
    """Run the four filters under every interpretation, and the other textures."""
    return mfpf.cells(size) + textures.cells(size)


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Make the tables, and judge them."""
    errors = {name: _errors(results, size, name) for name in mfpf.RIVALRIES}
    followed = {name: _followed(results, size, name) for name in mfpf.RIVALRIES}
    tables = {
        "RMS in px, mean ± standard deviation over the seeds:": _rms_table(errors, size),
        f"Runs that end with {mfpf.LAST_FRAMES} frames below {CLOSE_PX:g} px, "
        f"of {len(size.seeds)}:": _followed_table(followed, size),
        "The three textures, RMS in px:": textures.table(results, size),
    }
    shades = {name: OCCLUSION_SHADES[CASE_SCENES[name].occlusion] for name in mfpf.cases(size)}
    return ex.Report(
        _data(errors, followed, results, size),
        error_case_figure(errors[ex.PAPER_RULE], shades, [_short(n) for n in shades], "case"),
        ex.ExperimentVerdict(
            (
                *_claims(errors),
                *_further(errors, followed),
                textures.claim(results, size),
            ),
            mfpf.setting(size),
            _REMARKS,
        ),
        tables,
    )


def _short(case: str) -> str:
    return case.removeprefix("case")


def _errors(
    results: ex.Results, size: ex.Size, interpretation: str
) -> dict[str, dict[str, list[float]]]:
    return {
        case: {
            system.label: mfpf.per_seed(results, size, case, system, interpretation, "rmse_px")
            for system in mfpf.FOUR_SYSTEMS
        }
        for case in mfpf.cases(size)
    }


def _followed(results: ex.Results, size: ex.Size, interpretation: str) -> Followed:
    def is_close(case: str, system: System, seed: int) -> bool:
        scored = mfpf.run_scores(results, case, system, seed, interpretation)
        last = [frame.error for frame in scored.frames[-mfpf.LAST_FRAMES :]]
        return all(error is not None and error < CLOSE_PX for error in last)

    return {
        case: {
            system.label: [is_close(case, system, seed) for seed in size.seeds]
            for system in mfpf.FOUR_SYSTEMS
        }
        for case in mfpf.cases(size)
    }


def _data(
    errors: Mapping[str, Errors],
    followed: Mapping[str, Followed],
    results: ex.Results,
    size: ex.Size,
) -> ex.DataTable:
    rows: list[tuple[ex.Entry, ...]] = [
        (interpretation, case, label, "glcm", seed, rms, int(end))
        for interpretation, by_case in errors.items()
        for case, of_case in by_case.items()
        for label, values in of_case.items()
        for seed, rms, end in zip(
            size.seeds, values, followed[interpretation][case][label], strict=True
        )
    ]
    rows += [
        (ex.PAPER_RULE, case, label, texture, seed, rms, None)
        for texture, case, label, seed, rms in textures.rows(results, size)
    ]
    columns = ("interpretation", "case", "filter", "texture", "seed", "rmse_px",
               "followed_to_the_end")  # fmt: skip
    return ex.DataTable(columns, tuple(rows))


def _rms_table(errors: Mapping[str, Errors], size: ex.Size) -> ex.DataTable:
    rows: list[tuple[ex.Entry, ...]] = [
        (
            mfpf.read_label(label, interpretation),
            *(mean_and_spread(of_case[label]) for of_case in by_case.values()),
            mean_and_spread(_over_cases(by_case, label)),
        )
        for interpretation, by_case in errors.items()
        for label in _PAPER
    ]
    numbers = [int(_short(case)) - 1 for case in mfpf.cases(size)]
    rows += [
        (
            f"{label} in the paper",
            *(f"{values[n]:.2f}" for n in numbers),
            f"{fmean(values[n] for n in numbers):.2f}",
        )
        for label, values in _PAPER.items()
    ]
    return ex.DataTable(("filter", *mfpf.cases(size), "all"), tuple(rows))


def _followed_table(followed: Mapping[str, Followed], size: ex.Size) -> ex.DataTable:
    rows: list[tuple[ex.Entry, ...]] = [
        (
            mfpf.read_label(label, interpretation),
            *(sum(of_case[label]) for of_case in by_case.values()),
        )
        for interpretation, by_case in followed.items()
        for label in _PAPER
    ]
    return ex.DataTable(("filter", *mfpf.cases(size)), tuple(rows))


def _over_cases(errors: Errors, label: str) -> list[float]:
    """Mean RMS over the cases, for each seed."""
    return seed_means(by_label[label] for by_label in errors.values())


def _best_single(by_filter: Mapping[str, Sequence[float]]) -> str:
    return min(
        (single.label for single in mfpf.SINGLE_FEATURES), key=lambda label: fmean(by_filter[label])
    )


def _claims(errors: Mapping[str, Errors]) -> tuple[ex.Claim, ...]:
    return (
        ex.Claim(
            "MFPF has the least RMS in all cases",
            _PLACE,
            tuple(_least(interpretation, by_case) for interpretation, by_case in errors.items()),
            "yes: its mean over the seeds is, in all cases; partly: in one",
        ),
        ex.Claim(
            "its RMS is always 10 to 25 % below the least of the single-feature filters (3 to 23 % "
            "by the paper's own table)",
            _PLACE,
            tuple(_saving(interpretation, by_case) for interpretation, by_case in errors.items()),
            "yes: at least 10 % in all cases; partly: in one",
        ),
        ex.Claim(
            "no single feature is the best in all cases: each of them is in some",
            _PLACE,
            tuple(
                _no_single(interpretation, by_case) for interpretation, by_case in errors.items()
            ),
            "yes: by the mean RMS each of the three is the best somewhere; partly: two are",
        ),
    )


def _ratios(by_case: Errors) -> dict[str, float]:
    """MFPF's mean RMS over the best single-feature filter's, by case."""
    return {
        case: fmean(of_case[mfpf.MFPF.label]) / fmean(of_case[_best_single(of_case)])
        for case, of_case in by_case.items()
    }


def _numbers_text(by_case: Errors) -> str:
    return ", ".join(
        f"case {_short(case)} {ratio:.2f} of {_best_single(by_case[case])}'s"
        for case, ratio in _ratios(by_case).items()
    )


def _least(interpretation: str, by_case: Errors) -> ex.Finding:
    least = [ratio <= 1 for ratio in _ratios(by_case).values()]
    return ex.Finding(
        interpretation, ex.Holds.of(all(least), any(least)), f"MFPF's RMS: {_numbers_text(by_case)}"
    )


def _saving(interpretation: str, by_case: Errors) -> ex.Finding:
    enough = [ratio <= 1 - _AT_LEAST for ratio in _ratios(by_case).values()]
    saved = ", ".join(f"{100 * (1 - ratio):.0f}" for ratio in _ratios(by_case).values())
    return ex.Finding(
        interpretation,
        ex.Holds.of(all(enough), any(enough)),
        f"below it by {saved} % in the cases in order",
    )


def _no_single(interpretation: str, by_case: Errors) -> ex.Finding:
    best = {case: _best_single(of_case) for case, of_case in by_case.items()}
    parts = ", ".join(f"case {_short(case)} {label}" for case, label in best.items())
    kinds = len(set(best.values()))
    return ex.Finding(interpretation, ex.Holds.of(kinds == 3, kinds == 2), f"the best: {parts}")


def _further(
    errors: Mapping[str, Errors],
    followed: Mapping[str, Followed],
) -> tuple[ex.Claim, ...]:
    return (
        ex.Claim(
            "(the claims above taken together) over all cases MFPF's mean RMS is below that of the "
            "best single-feature filter",
            _PLACE,
            (
                *(
                    _over_all(interpretation, by_case, by_case)
                    for interpretation, by_case in errors.items()
                ),
                _over_all(
                    "the paper's rule, single features with their defaults",
                    errors[ex.PAPER_RULE],
                    errors[mfpf.DEFAULTS],
                ),
            ),
            "yes: its mean is below, and so it is with 80 % of the seeds; partly: one of the two",
        ),
        ex.Claim(
            "(not in the paper in numbers) MFPF follows to the end: in 8 of 10 runs where the "
            "vehicle is never hidden, and otherwise as often as the best single feature",
            "section V, cases 1 to 6",
            tuple(
                _to_the_end(interpretation, by_case) for interpretation, by_case in followed.items()
            ),
            f"yes: {mfpf.LAST_FRAMES} last frames below {CLOSE_PX:g} px so often in all cases; "
            "partly: in one, by one run at least",
        ),
    )


def _over_all(interpretation: str, by_case: Errors, rivals: Errors) -> ex.Finding:
    own = _over_cases(by_case, mfpf.MFPF.label)
    singles = {single.label: _over_cases(rivals, single.label) for single in mfpf.SINGLE_FEATURES}
    best = _best_single(singles)
    wins = [a < b for a, b in zip(own, singles[best], strict=True)]
    is_below = fmean(own) < fmean(singles[best])
    is_often = share(wins) >= _FOLLOWS
    return ex.Finding(
        interpretation,
        ex.Holds.of(is_below and is_often, is_below or is_often),
        f"{mean_and_spread(own)} px against {mean_and_spread(singles[best])} px of {best}: "
        f"{fmean(own) / fmean(singles[best]):.2f} times; below it with {sum(wins)} of "
        f"{len(wins)} seeds",
    )


def _to_the_end(interpretation: str, by_case: Followed) -> ex.Finding:
    enough = []
    parts = []
    for case, of_case in by_case.items():
        own = of_case[mfpf.MFPF.label]
        best = max(
            (single.label for single in mfpf.SINGLE_FEATURES), key=lambda label: sum(of_case[label])
        )
        needed = _FOLLOWS if case in mfpf.WITHOUT_HIDING else share(of_case[best])
        # As often as a rival that never does is not often enough.
        enough.append(any(own) and share(own) >= needed)
        parts.append(f"case {_short(case)} {sum(own)} ({best} {sum(of_case[best])})")
    runs = len(next(iter(next(iter(by_case.values())).values())))
    return ex.Finding(
        interpretation,
        ex.Holds.of(all(enough), any(enough)),
        f"of {runs} runs: {', '.join(parts)}",
    )


EXPERIMENT = ex.Experiment(
    "mfpf-table1", "MFPF, table I: the RMS error of the four filters in six cases", cells, report
)
