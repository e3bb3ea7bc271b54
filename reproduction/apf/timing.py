# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The processing times of the first paper's section IV, as ratios."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median

import numpy as np
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf import video3
from reproduction.apf.systems import APF, APF_RIVALS, SIX_SYSTEMS, ruled
from reproduction.numbers import median_and_range
from reproduction.runs.timing_cell import TimingCell

_MINUTES = {"APF": 14.5, "PF": 14.7, "SAPF": 14.8, "HPFMS": 15.2, "PFCL": 14.8, "MS": 12.7}
"""The paper's processing times on Video3, minutes."""
_PLACE = "section IV, processing times on Video3"
_LIKELIHOOD = "one likelihood"
"""Name of the findings: all trackers have the likelihood of APF."""
_ALIKE = 1.1
"""Ratios from one over this to this count as alike."""


def cells(size: ex.Size) -> list[TimingCell]:
    """Run all six in turns, once for each seed."""
    return [_cell(seed) for seed in size.seeds]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Compare the times as ratios to APF's."""
    times = {seed: results[_cell(seed)]["step_ms"] for seed in size.seeds}
    medians = {s.label: [median(times[seed][s.label]) for seed in size.seeds] for s in SIX_SYSTEMS}
    ratios = {
        label: [own / ours for own, ours in zip(of_tracker, medians[APF.label], strict=True)]
        for label, of_tracker in medians.items()
    }
    rows = tuple(
        (system.label, seed, frame, step)
        for system in SIX_SYSTEMS
        for seed in size.seeds
        for frame, step in enumerate(times[seed][system.label], start=2)
    )
    table = ex.DataTable(
        ("tracker", "ms per frame", "over APF's", "in the paper, min", "over APF's there"),
        tuple(
            (label, median_and_range(medians[label], 2), median_and_range(ratios[label], 2),
             f"{_MINUTES[label]:.1f}", f"{_MINUTES[label] / _MINUTES[APF.label]:.2f}")
            for label in medians
        ),
    )  # fmt: skip
    return ex.Report(
        ex.DataTable(("tracker", "seed", "frame", "step_ms"), rows),
        _figure(ratios),
        _verdict(ratios, size),
        {"Median over the frames; median and range over the seeds:": table},
    )


def _cell(seed: int) -> TimingCell:
    systems = tuple(ruled(video3.SCENE, system, seed).system for system in SIX_SYSTEMS)
    return TimingCell(video3.SCENE, systems, seed)


def _figure(ratios: dict[str, list[float]]) -> Figure:
    figure = Figure(figsize=(7, 3.6), layout="constrained")
    axes = figure.add_subplot()
    places = np.arange(len(ratios))
    ours = [median(of_tracker) for of_tracker in ratios.values()]
    paper = [_MINUTES[label] / _MINUTES[APF.label] for label in ratios]
    axes.bar(places - 0.2, paper, 0.38, color="0.75", ec="black", hatch="//", label="paper")
    axes.bar(places + 0.2, ours, 0.38, color="#0072B2", ec="black", label="here")
    ranges = [[min(of_tracker), max(of_tracker)] for of_tracker in ratios.values()]
    axes.vlines(places + 0.2, *zip(*ranges, strict=True), color="black", lw=1.5)
    axes.axhline(1, color="black", lw=0.8, ls=":")
    axes.set_xticks(places, list(ratios))
    axes.set(ylabel="time per frame over APF's")
    axes.legend(frameon=False)
    return figure


def _verdict(ratios: dict[str, list[float]], size: ex.Size) -> ex.ExperimentVerdict:
    return ex.ExperimentVerdict(
        (
            ex.Claim(
                "APF takes no more time than the other particle filters",
                _PLACE,
                (_no_more(ratios),),
                "yes: by the medians none of them takes less; partly: one takes no less",
            ),
            ex.Claim(
                "all particle filters take about the same time (within 5 % in the paper)",
                _PLACE,
                (_about_the_same(ratios),),
                "yes: the medians of all are within 10 % of APF's; partly: one is",
            ),
            ex.Claim(
                "mean shift takes the least time",
                _PLACE,
                (_least(ratios),),
                "yes: by the medians less than all others; partly: less than APF",
            ),
        ),
        f"{video3.SETTING} Processor time of one thread per step, all six in turns on each frame, "
        f"{len(size.seeds)} passes; the numbers of particles are the defaults (200; 25 with mean "
        "shift; four layers of 50). The paper gives minutes for the whole video, so only ratios "
        "compare.",
    )


def _filters(ratios: Mapping[str, Sequence[float]]) -> dict[str, float]:
    """Median ratio of the particle filters that APF is compared with."""
    return {rival.label: median(ratios[rival.label]) for rival in APF_RIVALS if rival.label != "MS"}


def _text(ratios: Mapping[str, Sequence[float]]) -> str:
    parts = (f"{label} {median_and_range(ratios[label], 2)}" for label in _filters(ratios))
    return f"times over APF's: {', '.join(parts)}"


def _no_more(ratios: Mapping[str, Sequence[float]]) -> ex.Finding:
    less = [ratio < 1 for ratio in _filters(ratios).values()]
    return ex.Finding(_LIKELIHOOD, ex.Holds.of(not any(less), not all(less)), _text(ratios))


def _about_the_same(ratios: Mapping[str, Sequence[float]]) -> ex.Finding:
    alike = [1 / _ALIKE <= ratio <= _ALIKE for ratio in _filters(ratios).values()]
    return ex.Finding(_LIKELIHOOD, ex.Holds.of(all(alike), any(alike)), _text(ratios))


def _least(ratios: Mapping[str, Sequence[float]]) -> ex.Finding:
    own = median(ratios["MS"])
    return ex.Finding(
        _LIKELIHOOD,
        ex.Holds.of(own <= min([1.0, *_filters(ratios).values()]), own < 1),
        f"{median_and_range(ratios['MS'], 2)} of APF's time",
    )


EXPERIMENT = ex.Experiment(
    "apf-timing", "APF, processing times: the six trackers' times as ratios", cells, report
)
