# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 7 of the first paper: the vehicle's way along x, as all six trackers see it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf import video3
from reproduction.apf.systems import APF_RIVALS, INTERPRETATIONS, SIX_SYSTEMS
from reproduction.drawing.shading import shade_occlusions
from reproduction.numbers import counted, share
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES
from vehicle_pf_tracker.evaluation.scores import Scores

_PLACE = "section IV, figure 7"


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the first seed's x, and judge all seeds."""
    runs = video3.all_scores(results, size)
    drawn = {system.label: runs[system.label][0] for system in SIX_SYSTEMS}
    return ex.Report(video3.data(runs, size), _figure(drawn), _verdict(runs, size))


def _figure(runs: dict[str, Scores]) -> Figure:
    figure = Figure(figsize=(9, 4.4), layout="constrained")
    axes = figure.add_subplot()
    first = next(iter(runs.values()))
    shade_occlusions(axes, first)
    true = [(f.row.frame, f.truth.box.centre[0]) for f in first.frames if f.truth is not None]
    axes.plot(*zip(*true, strict=True), color="0.55", lw=4.5, alpha=0.6, label="truth")
    for (label, scored), style in zip(runs.items(), LINE_STYLES, strict=True):
        drawn = [(f.row.frame, f.row.x) for f in scored.frames if f.row.x is not None]
        axes.plot(*zip(*drawn, strict=True), color=style.colour, ls=style.line, lw=1.6, label=label)
    axes.set(xlabel="frame", ylabel="x, px")
    axes.margins(x=0.01)
    video3.legend_below(axes)
    return figure


def _verdict(runs: dict[str, list[Scores]], size: ex.Size) -> ex.ExperimentVerdict:
    own = {
        interpretation: video3.recoveries(runs[system.label])
        for interpretation, system in INTERPRETATIONS.items()
    }
    others = {rival.label: video3.recoveries(runs[rival.label]) for rival in APF_RIVALS}
    return ex.ExperimentVerdict(
        (
            ex.Claim(
                "APF overcomes the total occlusions and follows the vehicle again",
                _PLACE,
                tuple(_overcomes(interpretation, hits) for interpretation, hits in own.items()),
                "yes: from 95 % of them; partly: from a quarter",
            ),
            ex.Claim(
                "PF, SAPF, HPFMS, PFCL and MS do not",
                _PLACE,
                (_others_lost(others),),
                "yes: they lose it in 95 % of them; partly: in half",
            ),
        ),
        f"{video3.SETTING} {len(size.seeds)} seeds; curves are those of the first.",
    )


def _overcomes(interpretation: str, hits: Sequence[bool]) -> ex.Finding:
    return ex.Finding(
        interpretation,
        ex.Holds.share(share(hits), partly=0.25),
        f"{counted(hits)} total occlusions recovered from",
    )


def _others_lost(others: Mapping[str, Sequence[bool]]) -> ex.Finding:
    lost = [not hit for hits in others.values() for hit in hits]
    parts = "; ".join(f"{label} {counted(hits)}" for label, hits in others.items())
    return ex.Finding("one likelihood", ex.Holds.share(share(lost)), f"recovered from: {parts}")


EXPERIMENT = ex.Experiment(
    "apf-fig7", "APF, figure 7: the way along x, as all six trackers see it", video3.cells, report
)
