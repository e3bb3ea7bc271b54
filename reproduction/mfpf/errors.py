# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures 5b to 15b of the second paper: the error in each frame, of all four filters."""

from __future__ import annotations

from collections.abc import Mapping
from statistics import fmean, pstdev

from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.drawing.bands import BANDS_NOTE, draw_band, legend_of, log_errors
from reproduction.drawing.shading import shade_occlusions
from reproduction.mfpf import systems as mfpf
from reproduction.mfpf.systems import FOUR_SYSTEMS, MFPF, RIVALRIES, SINGLE_FEATURES
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES

_PLACE = "section V, figures 5b to 15b"


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the errors with their spread, and judge all seeds."""
    rows: list[tuple[ex.Entry, ...]] = [
        (
            interpretation,
            case,
            system.label,
            seed,
            f.row.frame,
            f.error,
            f.truth.occlusion.name.lower(),
        )
        for interpretation in RIVALRIES
        for case in mfpf.cases(size)
        for system in FOUR_SYSTEMS
        for seed in size.seeds
        for f in mfpf.run_scores(results, case, system, seed, interpretation).frames
        if f.truth is not None
    ]
    columns = ("interpretation", "case", "filter", "seed", "frame", "error_px", "occlusion")
    return ex.Report(
        ex.DataTable(columns, tuple(rows)),
        _figure(results, size),
        ex.ExperimentVerdict(
            _claims(results, size),
            f"{mfpf.setting(size)} {BANDS_NOTE} The paper's rule is shown, on the paper's linear "
            "scale to the left and on a logarithmic one to the right.",
        ),
    )


def _figure(results: ex.Results, size: ex.Size) -> Figure:
    names = mfpf.cases(size)
    figure = Figure(figsize=(11, 2.5 * len(names) + 0.5), layout="constrained")
    grid = figure.subplots(len(names), 2, squeeze=False, sharex="row")
    for case, row in zip(names, grid, strict=True):
        # MFPF first: its line is solid.
        runs = {
            system.label: [mfpf.run_scores(results, case, system, seed) for seed in size.seeds]
            for system in (MFPF, *SINGLE_FEATURES)
        }
        for axes in row:
            shade_occlusions(axes, runs[MFPF.label][0])
            for (label, of_seeds), style in zip(runs.items(), LINE_STYLES, strict=False):
                draw_band(axes, of_seeds, style, label)
        row[0].set(ylim=(0, None), ylabel="error, px")
        row[0].set_title(f"case {case[-1]}: {mfpf.occlusion_text(case)}", fontsize="medium")
        log_errors(row[1])
    for axes in grid[-1]:
        axes.set(xlabel="frame")
    legend_of(figure, grid.flat)
    return figure


def _claims(results: ex.Results, size: ex.Size) -> tuple[ex.Claim, ...]:
    return (
        ex.Claim(
            "in the shadows of case 3 MFPF's error varies the least of all four, the edge filter's "
            "the most",
            "section V-C, figure 9b",
            tuple(
                _steadiest(interpretation, _spreads(results, size, interpretation))
                for interpretation in RIVALRIES
            ),
            "yes: by the standard deviation over the frames, mean of the seeds; partly: MFPF's is "
            "the least",
        ),
        ex.Claim(
            "MFPF is not the best in every frame: in a part of the sequence single features are "
            "ahead, though not on the whole",
            "section V-A and VI",
            tuple(
                _in_parts(interpretation, _parts(results, size, interpretation))
                for interpretation in RIVALRIES
            ),
            "yes: in all cases a single feature is ahead in some frames, and MFPF by the mean RMS; "
            "partly: in one case",
        ),
    )


def _errors(
    results: ex.Results, case: str, label: str, seed: int, interpretation: str
) -> list[float]:
    (system,) = (s for s in FOUR_SYSTEMS if s.label == label)
    frames = mfpf.run_scores(results, case, system, seed, interpretation).frames
    return [frame.error for frame in frames if frame.error is not None]


def _spreads(results: ex.Results, size: ex.Size, interpretation: str) -> Mapping[str, float]:
    """Mean over the seeds of each filter's deviation of the error over the frames of case 3."""
    case = size.of("case3", mfpf.cases(size)[0])
    return {
        system.label: fmean(
            pstdev(_errors(results, case, system.label, seed, interpretation))
            for seed in size.seeds
        )
        for system in FOUR_SYSTEMS
    }


def _steadiest(interpretation: str, spreads: Mapping[str, float]) -> ex.Finding:
    least, most = min(spreads, key=spreads.__getitem__), max(spreads, key=spreads.__getitem__)
    parts = ", ".join(f"{label} {value:.1f}" for label, value in spreads.items())
    return ex.Finding(
        interpretation,
        ex.Holds.of((least, most) == (MFPF.label, "Edge"), least == MFPF.label),
        f"standard deviation of the error over the frames, mean of the seeds: {parts} px",
    )


def _parts(
    results: ex.Results, size: ex.Size, interpretation: str
) -> Mapping[str, tuple[float, bool]]:
    """Share of the frames with MFPF ahead of all, and whether it is by its RMS, by case."""
    by_case = {}
    for case in mfpf.cases(size):
        shares = []
        for seed in size.seeds:
            errors = {
                s.label: _errors(results, case, s.label, seed, interpretation) for s in FOUR_SYSTEMS
            }
            own = errors.pop(MFPF.label)
            best = [min(of) for of in zip(*errors.values(), strict=True)]
            shares.append(fmean(a <= b for a, b in zip(own, best, strict=True)))
        totals = {
            s.label: fmean(mfpf.per_seed(results, size, case, s, interpretation, "rmse_px"))
            for s in FOUR_SYSTEMS
        }
        by_case[case] = fmean(shares), totals.pop(MFPF.label) <= min(totals.values())
    return by_case


def _in_parts(interpretation: str, by_case: Mapping[str, tuple[float, bool]]) -> ex.Finding:
    both = [ahead < 1 and on_the_whole for ahead, on_the_whole in by_case.values()]
    mean = fmean(ahead for ahead, _ in by_case.values())
    wholes = [on_the_whole for _, on_the_whole in by_case.values()]
    return ex.Finding(
        interpretation,
        ex.Holds.of(all(both), any(both)),
        f"ahead of all single features in {100 * mean:.0f} % of the frames; on the whole in "
        f"{sum(wholes)} of {len(wholes)} cases",
    )


EXPERIMENT = ex.Experiment(
    "mfpf-errors", "MFPF, figures 5b to 15b: the error in each frame, of all four filters",
    mfpf.cells, report,
)  # fmt: skip
