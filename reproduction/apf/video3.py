# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The common part of figures 5, 6 and 7 of the first paper: all six trackers on `video03`."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from reproduction.apf import systems as apf
from reproduction.experiment import DataTable, Results, Size
from reproduction.runs.cells import PATH_COLUMNS, RunCell, SceneChoice, System, scores
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import Scores

SCENE = SceneChoice.of("video03")
SYSTEMS = tuple(dict.fromkeys((*apf.INTERPRETATIONS.values(), *apf.APF_RIVALS)))
SETTING = (
    "The scene `video03` is our counterpart of the paper's Video3: a sport utility vehicle passes "
    "a lamp post, is hidden by a sign and then by a coach that overtakes; 15 frames per second. "
    "Each seed renders a new scene and seeds the trackers. " + apf.SIGMA_RULE
)
_RECORD = (*PATH_COLUMNS, "regime")


def cell(system: System, seed: int) -> RunCell:
    """Make the cell of `system`."""
    return apf.ruled(SCENE.seeded(seed), system, seed, _RECORD)


def cells(size: Size) -> list[RunCell]:
    """Run all trackers, and every interpretation of the paper's own, with every seed."""
    return [cell(system, seed) for system in SYSTEMS for seed in size.seeds]


def run_scores(results: Results, system: System, seed: int) -> Scores:
    """Score one run against the truth again."""
    return scores(cell(system, seed), results[cell(system, seed)])


def all_scores(results: Results, size: Size) -> dict[str, list[Scores]]:
    """Return the scores of every seed, by tracker."""
    return {
        system.label: [run_scores(results, system, seed) for seed in size.seeds]
        for system in SYSTEMS
    }


def data(runs: dict[str, list[Scores]], size: Size) -> DataTable:
    """Put every frame of every run into a row."""
    rows = tuple(
        (label, seed, f.row.frame, f.row.x, f.row.y, f.row.mode, f.error, *f.truth.box.centre,
         f.truth.occlusion.name.lower())
        for label, of_seeds in runs.items()
        for seed, scored in zip(size.seeds, of_seeds, strict=True)
        for f in scored.frames
        if f.truth is not None
    )  # fmt: skip
    columns = ("tracker", "seed", "frame", "x", "y", "mode", "error_px", "true_x", "true_y",
               "occlusion")  # fmt: skip
    return DataTable(columns, rows)


def recoveries(of_seeds: Sequence[Scores]) -> list[bool]:
    """Return for every judged total occlusion of every run whether it recovered."""
    verdicts = [verdict for scored in of_seeds for verdict in measure(scored).recovered]
    return [verdict for verdict in verdicts if verdict is not None]


def total_span(scored: Scores) -> tuple[int, int]:
    """Return the first and the last totally hidden frame."""
    frames = [f.row.frame for f in scored.frames if f.hidden]
    return frames[0], frames[-1]


def legend_below(axes: Axes) -> None:
    """Put the legend below the axis labels; the pad is in font sizes."""
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, 0.0), borderaxespad=3.6, ncols=5, frameon=False
    )
