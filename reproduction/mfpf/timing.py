# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The second paper's claim about time: three features take three times the time of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean, median

import numpy as np
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.mfpf import systems as mfpf
from reproduction.numbers import median_and_range
from reproduction.runs.cells import SceneChoice, System
from reproduction.runs.timing_cell import TimingCell, timed_seeds

_CASE = "case2"
"""A case in which nothing hides the vehicle wholly, so that all filters measure in every frame."""
_TRIPLE = 2.0, 4.0
"""Ratios that round to three, generously."""
_MORE = 1.2
"""Least ratio that counts as more time at all: a tenth is noise."""


def cells(size: ex.Size) -> list[TimingCell]:
    """Run the four filters in turns, once for each of a few seeds."""
    return [_cell(seed) for seed in timed_seeds(size)]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Compare the times as ratios to the mean of the single-feature filters'."""
    seeds = timed_seeds(size)
    systems = _systems()
    times = {seed: results[_cell(seed)]["step_ms"] for seed in seeds}
    means = {
        plain.label: [float(np.mean(times[seed][system.label])) for seed in seeds]
        for plain, system in zip(mfpf.FOUR_SYSTEMS, systems, strict=True)
    }
    rows = tuple(
        (system.label, seed, frame, step)
        for system in systems
        for seed in seeds
        for frame, step in enumerate(times[seed][system.label], start=2)
    )
    table = ex.DataTable(
        ("filter", "ms per frame"),
        tuple((label, median_and_range(values, 2)) for label, values in means.items()),
    )
    return ex.Report(
        ex.DataTable(("filter", "seed", "frame", "step_ms"), rows),
        _figure(means),
        ex.ExperimentVerdict(
            (
                ex.Claim(
                    "the three features triple the filter's calculation time",
                    "section VI",
                    (_tripled(_ratios(means)),),
                    f"yes: MFPF's time over the mean of the three single-feature filters' is "
                    f"{_TRIPLE[0]:g} to {_TRIPLE[1]:g} (median); partly: at least {_MORE:g}",
                ),
            ),
            f"Scene `{_CASE}`, the paper's rule, 200 particles in all filters. Processor time of "
            f"one thread per step, all four in turns on each frame, {len(seeds)} seeds.",
        ),
        {"Mean over the frames; median and range over the seeds:": table},
        seeds,
    )


def _systems() -> tuple[System, ...]:
    return tuple(mfpf.read_as(system, ex.PAPER_RULE) for system in mfpf.FOUR_SYSTEMS)


def _cell(seed: int) -> TimingCell:
    return TimingCell(SceneChoice.of(_CASE).seeded(seed), _systems(), seed)


def _ratios(means: Mapping[str, Sequence[float]]) -> list[float]:
    """MFPF's time over the mean of the three, for each seed."""
    singles = [means[single.label] for single in mfpf.SINGLE_FEATURES]
    return [own / fmean(of) for own, *of in zip(means[mfpf.MFPF.label], *singles, strict=True)]


def _tripled(ratios: Sequence[float]) -> ex.Finding:
    low, high = _TRIPLE
    middle = median(ratios)
    return ex.Finding(
        ex.PAPER_RULE,
        ex.Holds.of(low <= middle <= high, middle >= _MORE),
        f"{median_and_range(ratios, 2)} times the mean of the three",
    )


def _figure(means: Mapping[str, Sequence[float]]) -> Figure:
    figure = Figure(figsize=(6, 3.2), layout="constrained")
    axes = figure.add_subplot()
    axes.bar(list(means), [median(of) for of in means.values()], 0.6, color="#0072B2", ec="black")
    axes.set(ylabel="processor time, ms per frame")
    return figure


EXPERIMENT = ex.Experiment(
    "mfpf-timing", "MFPF, section VI: the time of three features over that of one", cells, report
)
