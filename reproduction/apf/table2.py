# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Table II of the first paper: the error of all six trackers on twenty videos.

With it goes what the paper does not show: the same trackers where nothing hides the vehicle, and
its rivals as their own papers have them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean, median
from typing import Any

from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf.published import (
    BESIDE,
    Errors,
    averages,
    beside_table,
    groups,
    published_ratio,
    rank_correlations,
    ratio_table,
    ratios,
    video_table,
)
from reproduction.apf.systems import (
    COMPARISONS,
    SIGMA_RULE,
    SIX_SYSTEMS,
    Comparison,
    ruled,
    sigma_of,
)
from reproduction.drawing.case_figure import OCCLUSION_SHADES, Values, error_case_figure
from reproduction.numbers import counted, mean_and_spread, median_and_range, share
from reproduction.runs.cells import RunCell, SceneChoice, System
from reproduction.scenes.paper_scenes import VIDEO_SCENES

_PLACE = "section IV, table II"
_QUICK_VIDEOS = "video06", "video15", "video19"
"""Videos of a quick run: one with a total occlusion, one with a partial one, one with none."""
_AT_MOST = 0.5
"""Share of the best rival's error that the paper's table stays well below (17.32 of 73.69)."""
_ALIKE = 1.25
"""Factor between our ratio and the paper's that still counts as agreement: on two videos with 10
seeds each, ratios of medians scatter by about a quarter."""
_SYSTEMS = (*SIX_SYSTEMS, *BESIDE)
_REMARKS = (
    "With their own `sigma_v` of 0.158 the rivals are less exact where nothing hides the vehicle, "
    "and APF is ahead or close there. It makes no difference to occlusions. "
    "No option of the rivals' own papers brings one over total occlusions. Tried were HPFMS with "
    "50 particles, which makes 200 measurements a frame like the others (25 particles make 100), "
    "SAPF with `annealing.tied`, and PF with second-order `dynamics` and 1 px/frame of noise.",
)


def cells(size: ex.Size) -> list[RunCell]:
    """Run all trackers, in every form, on every video."""
    return [
        _cell(video, system, seed)
        for video in _videos(size)
        for system in _SYSTEMS
        for seed in size.seeds
    ]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Make the tables, and judge them."""
    videos = {
        video: {
            system.label: [metrics["rmse_px"] for metrics in _metrics(results, size, video, system)]
            for system in _SYSTEMS
        }
        for video in _videos(size)
    }
    recovered = {system.label: _recoveries(results, size, system) for system in _SYSTEMS}
    tables = {
        "RMSE in px, mean ± standard deviation over the seeds, and the paper's in brackets; one "
        "sigma_v for all:": video_table(videos),
        "RMSE of APF over that of the best rival (medians over the seeds):": ratio_table(videos),
        "All forms of the trackers, RMSE in px averaged over videos:": beside_table(
            videos, recovered
        ),
    }
    return ex.Report(
        _data(results, size),
        table_figure(videos),
        ex.ExperimentVerdict(_claims(videos, recovered), _setting(size), _REMARKS),
        tables,
    )


def _setting(size: ex.Size) -> str:
    return (
        "Scenes `video01` to `video20` are counterparts of the paper's table I (see `apf-table1`), "
        f"made before any tracker ran on them. Seeds {size.seeds.start} to {size.seeds.stop - 1}: "
        "each renders a new scene "
        f"(colour of the vehicle, traffic, ground, noise) and seeds the tracker. {SIGMA_RULE} The "
        "rule was chosen on 14 scenes with seeds from 100 on: of three that follow the speed (1 "
        "and 1.5 times the nominal one, 1 times the highest) it gave the six trackers together the "
        "least error, 23.7 px (geometric mean). A constant of 10 px/frame, which does not follow "
        "the speed, gave 22.6 px."
    )


def _videos(size: ex.Size) -> tuple[str, ...]:
    return size.of(tuple(VIDEO_SCENES), _QUICK_VIDEOS)


def _cell(video: str, system: System, seed: int) -> RunCell:
    return ruled(SceneChoice.of(video).seeded(seed), system, seed)


def _metrics(
    results: ex.Results, size: ex.Size, video: str, system: System
) -> list[Mapping[str, Any]]:
    return [results[_cell(video, system, seed)]["metrics"] for seed in size.seeds]


def _recoveries(results: ex.Results, size: ex.Size, system: System) -> list[bool]:
    verdicts = [
        occlusion["recovered"]
        for video in _videos(size)
        for metrics in _metrics(results, size, video, system)
        for occlusion in metrics["occlusions"]
    ]
    return [verdict for verdict in verdicts if verdict is not None]


def _data(results: ex.Results, size: ex.Size) -> ex.DataTable:
    rows: list[tuple[ex.Entry, ...]] = []
    for cell in cells(size):
        metrics = results[cell]["metrics"]
        hits = [occlusion["recovered"] for occlusion in metrics["occlusions"]]
        rows.append(
            (
                cell.scene.name,
                cell.system.label,
                cell.seed,
                sigma_of(cell.system),
                metrics["rmse_px"],
                metrics["rmse_visible_px"],
                metrics["on_target"],
                len(hits),
                hits.count(True),
            )
        )
    columns = ("scene", "tracker", "seed", "sigma", "rmse_px", "rmse_visible_px", "on_target",
               "total_occlusions", "recovered")  # fmt: skip
    return ex.DataTable(columns, tuple(rows))


def _claims(videos: Errors, recovered: Mapping[str, Sequence[bool]]) -> tuple[ex.Claim, ...]:
    kinds = groups(videos)
    return (
        ex.Claim(
            "over all videos APF has the smallest average RMSE",
            _PLACE,
            tuple(_first(videos, kinds["average"], comparison, 1.0) for comparison in COMPARISONS),
            "yes: its mean is at most the best rival's; partly: it is with half of the seeds",
        ),
        ex.Claim(
            "on the videos with total occlusions it is far ahead: at most half of the best rival's "
            "average (in the paper about a quarter)",
            _PLACE,
            tuple(
                _first(videos, kinds["total occlusion"], comparison, _AT_MOST)
                for comparison in COMPARISONS
            ),
            "yes: at most half of it; partly: it is below the rival's with half of the seeds",
        ),
        ex.Claim(
            "it is ahead on every video with a partial or total occlusion",
            _PLACE,
            tuple(_everywhere(videos, comparison) for comparison in COMPARISONS),
            "yes: on 95 % of them by the median over the seeds; partly: on half",
        ),
        ex.Claim(
            "after the occlusion APF resumes tracking, the others do not",
            _PLACE,
            tuple(_resumes(recovered, comparison) for comparison in COMPARISONS),
            "yes: APF recovers from 90 % of them, each other from less than half; partly: APF "
            "recovers most often",
        ),
        ex.Claim(
            "without occlusion (videos 19 and 20) APF is a little behind the best rival: 1.12 and "
            f"1.39 times its RMSE (within a factor of {_ALIKE:g})",
            _PLACE,
            tuple(_unoccluded(videos, comparison) for comparison in COMPARISONS),
            "yes: both ratios of medians are within that factor; partly: one is",
        ),
        ex.Claim(
            "(not a claim of the paper's) our scenes are hard where its videos are: over the "
            "videos each tracker's RMSE has a rank correlation of at least 0.7 with the paper's",
            _PLACE,
            (_alike(rank_correlations(videos)),),
            "yes: for each; partly: their median is at least 0.4",
        ),
    )


def _best(videos: Errors, names: Sequence[str], comparison: Comparison) -> tuple[str, list[float]]:
    means = {rival.label: averages(videos, names, rival.label) for rival in comparison.rivals}
    label = min(means, key=lambda name: fmean(means[name]))
    return label, means[label]


def _first(
    videos: Errors, names: Sequence[str], comparison: Comparison, at_most: float
) -> ex.Finding:
    own = averages(videos, names, comparison.apf.label)
    label, best = _best(videos, names, comparison)
    ratio = fmean(own) / fmean(best)
    ahead = [ours < theirs for ours, theirs in zip(own, best, strict=True)]
    return ex.Finding(
        comparison.name,
        ex.Holds.of(ratio <= at_most, share(ahead) >= 0.5),
        f"{mean_and_spread(own)} px against {mean_and_spread(best)} px of {label}, the best rival: "
        f"{ratio:.2f} times; by seed {median_and_range(own)} px",
    )


def _everywhere(videos: Errors, comparison: Comparison) -> ex.Finding:
    occluded = {name: of for name, of in videos.items() if VIDEO_SCENES[name].occlusion != "none"}
    by_video = ratios(occluded, comparison.apf.label, comparison.rival_labels)
    ahead = [ratio <= 1 for ratio in by_video.values()]
    behind = ", ".join(name.removeprefix("video") for name, ratio in by_video.items() if ratio > 1)
    parts = f"; behind on {behind}" if any(ahead) and behind else ""
    return ex.Finding(
        comparison.name,
        ex.Holds.share(share(ahead)),
        f"smallest median RMSE on {counted(ahead)} of them{parts}",
    )


def _resumes(recovered: Mapping[str, Sequence[bool]], comparison: Comparison) -> ex.Finding:
    own = recovered[comparison.apf.label]
    others = {label: recovered[label] for label in comparison.rival_labels}
    parts = "; ".join(f"{label} {counted(hits)}" for label, hits in others.items())
    return ex.Finding(
        comparison.name,
        ex.Holds.of(
            share(own) >= 0.9 and all(share(hits) < 0.5 for hits in others.values()),
            share(own) > max(map(share, others.values())),
        ),
        f"recovered from {counted(own)} total occlusions; {parts}",
    )


def _unoccluded(videos: Errors, comparison: Comparison) -> ex.Finding:
    clear = {name: of for name, of in videos.items() if VIDEO_SCENES[name].occlusion == "none"}
    by_video = ratios(clear, comparison.apf.label, comparison.rival_labels)
    alike = [1 / _ALIKE <= r / published_ratio(name) <= _ALIKE for name, r in by_video.items()]
    parts = ", ".join(
        f"{name} {ratio:.2f} (paper {published_ratio(name):.2f})"
        for name, ratio in by_video.items()
    )
    return ex.Finding(
        comparison.name, ex.Holds.of(all(alike), any(alike)), f"APF over the best rival: {parts}"
    )


def _alike(correlations: Mapping[str, float]) -> ex.Finding:
    parts = ", ".join(f"{label} {rank:.2f}" for label, rank in correlations.items())
    return ex.Finding(
        ex.PAPER_RULE,
        ex.Holds.of(min(correlations.values()) >= 0.7, median(correlations.values()) >= 0.4),
        parts,
    )


EXPERIMENT = ex.Experiment(
    "apf-table2", "APF, table II: the error of all six trackers on twenty videos", cells, report
)


def table_figure(videos: Values) -> Figure:
    """Draw medians as marks and ranges as lines, on a logarithmic scale."""
    shown = {
        name: {system.label: errors[system.label] for system in SIX_SYSTEMS}
        for name, errors in videos.items()
    }
    shades = {name: OCCLUSION_SHADES[VIDEO_SCENES[name].occlusion] for name in videos}
    names = [name.removeprefix("video") for name in videos]
    return error_case_figure(shown, shades, names, "video")
