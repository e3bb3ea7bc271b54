# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The third paper's claim about time: adaptive resampling does not take more of it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from statistics import median

import numpy as np
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.numbers import median_and_range
from reproduction.resampling import systems as resampling
from reproduction.resampling.systems import INTERPRETATIONS
from reproduction.runs.timing_cell import TimingCell, timed_seeds

_SYSTEMS = tuple(dict.fromkeys(system for view in INTERPRETATIONS.values() for system in view.pair))


def cells(size: ex.Size) -> list[TimingCell]:
    """Run all in turns, once for each of a few seeds."""
    return [_cell(seed) for seed in timed_seeds(size)]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Compare the times as ratios to the conventional filter's."""
    seeds = timed_seeds(size)
    times = {seed: results[_cell(seed)]["step_ms"] for seed in seeds}
    means = {
        system.label: [float(np.mean(times[seed][system.label])) for seed in seeds]
        for system in _SYSTEMS
    }
    ratios = {
        interpretation: [
            own / other
            for other, own in zip(*(means[system.label] for system in view.pair), strict=True)
        ]
        for interpretation, view in INTERPRETATIONS.items()
    }
    rows = tuple(
        (system.label, seed, frame, step)
        for system in _SYSTEMS
        for seed in seeds
        for frame, step in enumerate(times[seed][system.label], start=2)
    )
    table = ex.DataTable(
        ("interpretation", "conventional, ms per frame", "adaptive, ms per frame", "ratio"),
        tuple(
            (interpretation, *(median_and_range(means[system.label], 2) for system in view.pair),
             median_and_range(ratios[interpretation], 2))
            for interpretation, view in INTERPRETATIONS.items()
        ),
    )  # fmt: skip
    return ex.Report(
        ex.DataTable(("filter", "seed", "frame", "step_ms"), rows),
        _figure(means),
        _verdict(ratios, size),
        {"Mean over the frames; median and range over the seeds:": table},
        seeds,
    )


def _cell(seed: int) -> TimingCell:
    return TimingCell(resampling.SCENE.seeded(seed), _SYSTEMS, seed)


def _figure(means: dict[str, list[float]]) -> Figure:
    figure = Figure(figsize=(10, 4.4), layout="constrained")
    axes = figure.add_subplot()
    places = np.arange(len(INTERPRETATIONS))
    looks = ("0.75", "//"), ("#0072B2", "")
    for which, (name, (colour, hatch)) in enumerate(
        zip(("conventional", "adaptive"), looks, strict=True)
    ):
        of_view = [means[view.pair[which].label] for view in INTERPRETATIONS.values()]
        at = places + (which - 0.5) * 0.4
        axes.bar(
            at,
            [median(f) for f in of_view],
            0.38,
            ec="black",
            label=name,
            color=colour,
            hatch=hatch,
        )
        axes.vlines(at, [min(f) for f in of_view], [max(f) for f in of_view], color="black", lw=1.5)
    axes.set_xticks(places, [textwrap.fill(name, 14) for name in INTERPRETATIONS])
    axes.set(ylabel="processor time, ms per frame")
    axes.legend(frameon=False)
    return figure


def _no_more_time(interpretation: str, of_seeds: Sequence[float]) -> ex.Finding:
    return ex.Finding(
        interpretation,
        ex.Holds.of(max(of_seeds) <= 1, median(of_seeds) <= 1),
        f"{median_and_range(of_seeds, 2)} times the conventional filter's time",
    )


def _verdict(ratios: dict[str, list[float]], size: ex.Size) -> ex.ExperimentVerdict:
    return ex.ExperimentVerdict(
        (
            ex.Claim(
                "the adaptive filter takes no more time than the conventional one",
                "abstract and section VI",
                tuple(
                    _no_more_time(interpretation, of_seeds)
                    for interpretation, of_seeds in ratios.items()
                ),
                "yes: with every seed; partly: by the median",
            ),
        ),
        f"{resampling.SETTING} Processor time of one thread per step, all filters in turns on each "
        f"frame, {len(timed_seeds(size))} seeds.",
    )


EXPERIMENT = ex.Experiment(
    "resampling-cost", "Adaptive resampling: processor time per frame of both filters", cells,
    report,
)  # fmt: skip
