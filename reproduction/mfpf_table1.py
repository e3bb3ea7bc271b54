# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Table I of the second paper: the RMS error of the four filters in six cases.

With it go the paper's claim on textures, and its assumption that the filter follows the vehicle to
the end.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean

from reproduction import mfpf_kept as kept
from reproduction import mfpf_systems as mfpf
from reproduction import mfpf_textures as textures
from reproduction.case_figure import SHADES, error_case_figure
from reproduction.cells import RunCell, System
from reproduction.experiment import (
    PAPER,
    Claim,
    DataTable,
    Entry,
    Experiment,
    ExperimentVerdict,
    Finding,
    Holds,
    Report,
    Results,
    Size,
)
from reproduction.mfpf_systems import (
    DEFAULTS,
    FOUR,
    INTERPRETATIONS,
    MFPF,
    SINGLES,
)
from reproduction.numbers import mean_and_spread, share
from reproduction.paper_scenes import CASES
from vehicle_pf_tracker.evaluation.occlusions import CLOSE_PX

_PLACE = "section V, table I"
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
_FOLLOWS, _AT_LEAST = 0.8, 0.10
"""Share of the runs that have to be followed; the least saving that the paper speaks of."""

Errors = Mapping[str, Mapping[str, Sequence[float]]]
"""RMS of each seed, by case and by filter."""


def cells(size: Size) -> list[RunCell]:
    """Run the four filters under every interpretation, and the other textures."""
    return mfpf.cells(size) + textures.cells(size)


def report(results: Results, size: Size) -> Report:
    """Make the tables, and judge them."""
    errors = {
        interpretation: _errors(results, size, interpretation, FOUR)
        for interpretation in INTERPRETATIONS
    }
    followed = {
        interpretation: _followed(results, size, interpretation)
        for interpretation in INTERPRETATIONS
    }
    tables = {
        "RMS in px, mean ± standard deviation over the seeds:": _rms_table(errors, size),
        f"Runs that end with {mfpf.LAST_FRAMES} frames below {CLOSE_PX:g} px, "
        f"of {len(size.seeds)}:": _followed_table(followed, size),
        "Runs that never lost the vehicle / runs that did: mean RMS in px, and in brackets how "
        "many (lost: a visible frame with an error of half its box's diagonal):": kept.table(
            results, size
        ),
        "The three textures, RMS in px:": textures.table(results, size),
    }
    shades = {name: SHADES[CASES[name].occlusion] for name in mfpf.cases(size)}
    return Report(
        _data(results, size),
        error_case_figure(errors[PAPER], shades, [_short(n) for n in shades], "case"),
        ExperimentVerdict(
            (
                *_claims(errors),
                *_further(errors, followed),
                kept.claim(results, size),
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
    results: Results, size: Size, interpretation: str, systems: Sequence[System]
) -> dict[str, dict[str, list[float]]]:
    return {
        case: {
            system.label: mfpf.per_seed(results, size, case, system, interpretation, "rmse_px")
            for system in systems
        }
        for case in mfpf.cases(size)
    }


def _followed(
    results: Results, size: Size, interpretation: str
) -> dict[str, dict[str, list[bool]]]:
    """Return for each seed whether the run ends close to the vehicle, by case and filter."""
    return {
        case: {
            system.label: [
                all(
                    frame.error is not None and frame.error < CLOSE_PX
                    for frame in mfpf.run_scores(
                        results, case, system, seed, interpretation
                    ).frames[-mfpf.LAST_FRAMES :]
                )
                for seed in size.seeds
            ]
            for system in FOUR
        }
        for case in mfpf.cases(size)
    }


def _data(results: Results, size: Size) -> DataTable:
    followed = {
        interpretation: _followed(results, size, interpretation)
        for interpretation in INTERPRETATIONS
    }
    rows: list[tuple[Entry, ...]] = []
    for interpretation in INTERPRETATIONS:
        for case in mfpf.cases(size):
            for system in FOUR:
                values = mfpf.per_seed(results, size, case, system, interpretation, "rmse_px")
                rows += [
                    (interpretation, case, system.label, "glcm", seed, rms, int(end))
                    for seed, rms, end in zip(
                        size.seeds,
                        values,
                        followed[interpretation][case][system.label],
                        strict=True,
                    )
                ]
    rows += [
        (PAPER, case, label, texture, seed, rms, None)
        for texture, case, label, seed, rms in textures.rows(results, size)
    ]
    columns = (
        "interpretation",
        "case",
        "filter",
        "texture",
        "seed",
        "rmse_px",
        "followed_to_the_end",
    )
    return DataTable(columns, tuple(rows))


def _rms_table(errors: Mapping[str, Errors], size: Size) -> DataTable:
    rows: list[tuple[Entry, ...]] = [
        (mfpf.read_label(label, interpretation),
         *(mean_and_spread(of_case[label]) for of_case in found.values()),
         mean_and_spread(_over_cases(found, label)))
        for interpretation, found in errors.items()
        for label in _PAPER
    ]  # fmt: skip
    numbers = [int(_short(case)) - 1 for case in mfpf.cases(size)]
    rows += [
        (f"{label} in the paper", *(f"{values[n]:.2f}" for n in numbers),
         f"{fmean(values[n] for n in numbers):.2f}")
        for label, values in _PAPER.items()
    ]  # fmt: skip
    return DataTable(("filter", *mfpf.cases(size), "all"), tuple(rows))


def _followed_table(
    followed: Mapping[str, Mapping[str, Mapping[str, Sequence[bool]]]], size: Size
) -> DataTable:
    rows: list[tuple[Entry, ...]] = [
        (mfpf.read_label(label, interpretation),
         *(sum(of_case[label]) for of_case in found.values()))
        for interpretation, found in followed.items()
        for label in _PAPER
    ]  # fmt: skip
    return DataTable(("filter", *mfpf.cases(size)), tuple(rows))


def _over_cases(errors: Errors, label: str) -> list[float]:
    """Mean RMS over the cases, for each seed."""
    return [fmean(of) for of in zip(*(found[label] for found in errors.values()), strict=True)]


def _best_single(found: Mapping[str, Sequence[float]]) -> str:
    return min((single.label for single in SINGLES), key=lambda label: fmean(found[label]))


def _claims(errors: Mapping[str, Errors]) -> tuple[Claim, ...]:
    return (
        Claim(
            "MFPF has the least RMS in all cases",
            _PLACE,
            tuple(_least(interpretation, found) for interpretation, found in errors.items()),
        ),
        Claim(
            "its RMS is always 10 to 25 % below the least of the single-feature filters (3 to 23 % "
            "by the paper's own table)",
            _PLACE,
            tuple(_saving(interpretation, found) for interpretation, found in errors.items()),
        ),
        Claim(
            "no single feature is the best in all cases",
            _PLACE,
            tuple(_no_single(interpretation, found) for interpretation, found in errors.items()),
        ),
    )


def _ratios(found: Errors) -> dict[str, float]:
    """MFPF's mean RMS over the best single-feature filter's, by case."""
    return {
        case: fmean(of_case[MFPF.label]) / fmean(of_case[_best_single(of_case)])
        for case, of_case in found.items()
    }


def _numbers_text(found: Errors) -> str:
    return ", ".join(
        f"case {_short(case)} {ratio:.2f} of {_best_single(found[case])}'s"
        for case, ratio in _ratios(found).items()
    )


def _least(interpretation: str, found: Errors) -> Finding:
    least = [ratio <= 1 for ratio in _ratios(found).values()]
    return Finding(
        interpretation, Holds.of(all(least), any(least)), f"MFPF's RMS: {_numbers_text(found)}"
    )


def _saving(interpretation: str, found: Errors) -> Finding:
    enough = [ratio <= 1 - _AT_LEAST for ratio in _ratios(found).values()]
    saved = ", ".join(f"{100 * (1 - ratio):.0f}" for ratio in _ratios(found).values())
    return Finding(
        interpretation, Holds.of(all(enough), any(enough)),
        f"below it by {saved} % in the cases in order",
    )  # fmt: skip


def _no_single(interpretation: str, found: Errors) -> Finding:
    best = {case: _best_single(of_case) for case, of_case in found.items()}
    parts = ", ".join(f"case {_short(case)} {label}" for case, label in best.items())
    return Finding(interpretation, Holds.of(len(set(best.values())) > 1), f"the best: {parts}")


def _further(
    errors: Mapping[str, Errors],
    followed: Mapping[str, Mapping[str, Mapping[str, Sequence[bool]]]],
) -> tuple[Claim, ...]:
    return (
        Claim(
            "(the claims above taken together) over all cases MFPF's mean RMS is below that of the "
            "best single-feature filter",
            _PLACE,
            (
                *(
                    _over_all(interpretation, found, found)
                    for interpretation, found in errors.items()
                ),
                _over_all(
                    "the paper's rule, single features with their defaults",
                    errors[PAPER],
                    errors[DEFAULTS],
                ),
            ),
        ),
        Claim(
            "(not in the paper in numbers) MFPF follows to the end: in 8 of 10 runs where the "
            "vehicle is never hidden, and otherwise as often as the best single feature",
            "section V, cases 1 to 6",
            tuple(_to_the_end(interpretation, found) for interpretation, found in followed.items()),
        ),
    )


def _over_all(interpretation: str, found: Errors, rivals: Errors) -> Finding:
    own = _over_cases(found, MFPF.label)
    singles = {single.label: _over_cases(rivals, single.label) for single in SINGLES}
    best = _best_single(singles)
    wins = [a < b for a, b in zip(own, singles[best], strict=True)]
    return Finding(
        interpretation,
        Holds.of(fmean(own) < fmean(singles[best])),
        f"{mean_and_spread(own)} px against {mean_and_spread(singles[best])} px of {best}: "
        f"{fmean(own) / fmean(singles[best]):.2f} times; below it with {sum(wins)} of "
        f"{len(wins)} seeds",
    )


def _to_the_end(interpretation: str, found: Mapping[str, Mapping[str, Sequence[bool]]]) -> Finding:
    enough, parts = [], []
    for case, of_case in found.items():
        own = of_case[MFPF.label]
        best = max((single.label for single in SINGLES), key=lambda label: sum(of_case[label]))
        needed = _FOLLOWS if case in mfpf.WITHOUT_HIDING else share(of_case[best])
        enough.append(share(own) >= needed)
        parts.append(f"case {_short(case)} {sum(own)} ({best} {sum(of_case[best])})")
    runs = len(next(iter(next(iter(found.values())).values())))
    return Finding(
        interpretation,
        Holds.of(all(enough), any(enough)),
        f"of {runs} runs: {', '.join(parts)}",
    )


EXPERIMENT = Experiment(
    "mfpf-table1", "MFPF, table I: the RMS error of the four filters in six cases", cells, report
)
