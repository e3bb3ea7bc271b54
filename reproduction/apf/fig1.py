# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 1 of the first paper: the error over sigma and the vehicle's speed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf.systems import (
    BAR_SETTING,
    INTERPRETATIONS,
    INTERPRETATIONS_NOTE,
    artificial_video,
    with_sigma,
)
from reproduction.runs.cells import RunCell
from vehicle_pf_tracker.evaluation.scores import CLOSE_PX

_SPEEDS = tuple(range(2, 21, 2)), (4, 12)
_SIGMAS = tuple(range(1, 21)), (2, 6, 12)
"""Axes of the paper's figure, px/frame, in full and quick."""
_PLACE = "section IV, figure 1"
_SLOPES = 0.4, 0.6
"""Slopes of the best sigma over the speed that round to a half."""
_FLAT = 1.25
"""Errors up to this multiple of the least count as no worse: minima are flat."""

Grid = npt.NDArray[np.float64]


def cells(size: ex.Size) -> list[RunCell]:
    """Run every interpretation at every speed with every sigma and seed."""
    return [_cell(*point, seed) for point in _points(size) for seed in size.seeds]


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Draw the errors as grey levels, and look for the best sigma of each speed."""
    rows = tuple(
        (interpretation, speed, sigma, seed, _rmse(results, (interpretation, speed, sigma), seed))
        for interpretation, speed, sigma in _points(size)
        for seed in size.seeds
    )
    grids = {
        interpretation: _grid(results, interpretation, size) for interpretation in INTERPRETATIONS
    }
    return ex.Report(
        ex.DataTable(("interpretation", "speed", "sigma", "seed", "rmse_px"), rows),
        _figure(grids, size),
        _verdict(grids, size),
    )


def _points(size: ex.Size) -> list[tuple[str, int, int]]:
    speeds, sigmas = size.of(*_SPEEDS), size.of(*_SIGMAS)
    return [
        (interpretation, speed, sigma)
        for interpretation in INTERPRETATIONS
        for speed in speeds
        for sigma in sigmas
    ]


def _cell(interpretation: str, speed: int, sigma: int, seed: int) -> RunCell:
    scene = artificial_video(0, speed)
    return RunCell(scene, with_sigma(INTERPRETATIONS[interpretation], float(sigma)), seed)


def _rmse(results: ex.Results, point: tuple[str, int, int], seed: int) -> float:
    return float(results[_cell(*point, seed)]["metrics"]["rmse_px"])


def _grid(results: ex.Results, interpretation: str, size: ex.Size) -> Grid:
    """RMSE by speed, sigma and seed."""
    return np.array(
        [
            [
                [_rmse(results, (interpretation, speed, sigma), seed) for seed in size.seeds]
                for sigma in size.of(*_SIGMAS)
            ]
            for speed in size.of(*_SPEEDS)
        ]
    )


def _figure(grids: Mapping[str, Grid], size: ex.Size) -> Figure:
    speeds, sigmas = np.array(size.of(*_SPEEDS)), np.array(size.of(*_SIGMAS))
    figure = Figure(figsize=(11, 4.4), layout="constrained")
    axes = figure.subplots(1, len(grids), sharey=True)
    for ax, (interpretation, grid) in zip(axes, grids.items(), strict=True):
        means = grid.mean(axis=2)
        image = ax.pcolormesh(
            speeds, sigmas, means.T, shading="nearest", cmap="gray_r", norm=LogNorm(1, 300)
        )
        ax.plot(speeds, speeds / 2, color="#D55E00", ls="--", lw=1.8, label="sigma = speed / 2")
        ax.plot(speeds, speeds, color="#0072B2", ls=":", lw=1.8, label="sigma = speed")
        ax.plot(
            speeds,
            sigmas[means.argmin(axis=1)],
            ls="",
            marker="o",
            ms=7,
            color="white",
            mec="black",
            label="least error at this speed",
        )
        ax.contour(speeds, sigmas, means.T, [CLOSE_PX], colors="black", linewidths=1.2)
        ax.set(title=interpretation, xlabel="speed, px/frame", xticks=speeds)
    axes[0].set(ylabel="sigma, px/frame")
    axes[0].set_yticks(range(0, sigmas[-1] + 1, 2))
    axes[0].set_ylim(sigmas[0] - 0.5, sigmas[-1] + 0.5)
    bar = figure.colorbar(image, ax=axes, label="RMSE, px (line: 15 px)", format="{x:g}")
    bar.set_ticks([1, 3, 10, 30, 100, 300])
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return figure


def _verdict(grids: Mapping[str, Grid], size: ex.Size) -> ex.ExperimentVerdict:
    speeds, sigmas = size.of(*_SPEEDS), size.of(*_SIGMAS)
    return ex.ExperimentVerdict(
        (
            ex.Claim(
                "for each speed there is a sigma with the least error, about half the speed",
                _PLACE,
                tuple(_least(name, grid, size) for name, grid in grids.items()),
                "yes: a line fitted to the best sigmas has a slope of 0.4 to 0.6; partly: at half "
                "of the speeds the error at half the speed is at most 1.25 times the least",
            ),
            ex.Claim(
                "larger sigmas than half the speed give low errors too",
                _PLACE,
                tuple(_above(name, grid, size) for name, grid in grids.items()),
                "yes: 95 % of the runs there have an RMSE below 15 px; partly: 75 %",
            ),
        ),
        f"{BAR_SETTING} No bar; speeds from {speeds[0]} to {speeds[-1]} and sigma from "
        f"{sigmas[0]} to {sigmas[-1]} px/frame, {len(size.seeds)} seeds; grey levels are means "
        "over the seeds. "
        f"{INTERPRETATIONS_NOTE}",
    )


def _least(interpretation: str, grid: Grid, size: ex.Size) -> ex.Finding:
    speeds, sigmas = np.array(size.of(*_SPEEDS), float), np.array(size.of(*_SIGMAS), float)
    means = grid.mean(axis=2)
    best = sigmas[means.argmin(axis=1)]
    holding = np.all(grid < CLOSE_PX, axis=2)
    if not np.any(holding):
        parts = f"no sigma follows the vehicle (least mean RMSE: {means.min():.0f} px)"
        return ex.Finding(interpretation, ex.Holds.NO, parts)
    slope = float(speeds @ best / (speeds @ speeds))
    followed = np.any(holding, axis=1)
    first = sigmas[holding.argmax(axis=1)]
    boundary = float(speeds[followed] @ first[followed] / (speeds[followed] @ speeds[followed]))
    low, high = _SLOPES
    halves = means[
        np.arange(len(speeds)), np.abs(sigmas - speeds[:, np.newaxis] / 2).argmin(axis=1)
    ]
    flat = float((halves <= _FLAT * means.min(axis=1)).mean())
    return ex.Finding(
        interpretation,
        ex.Holds.of(low <= slope <= high, flat >= 0.5),
        f"best sigma = {slope:.2f} speed (fitted; at each speed: "
        f"{', '.join(f'{v:g}: {s:g}' for v, s in zip(speeds, best, strict=True))}); "
        f"half the speed is as good at {flat:.0%} of the speeds; "
        "losing the vehicle ends (least sigma that keeps all seeds below 15 px) at "
        f"{boundary:.2f} speed",
    )


def _above(interpretation: str, grid: Grid, size: ex.Size) -> ex.Finding:
    speeds, sigmas = np.array(size.of(*_SPEEDS)), np.array(size.of(*_SIGMAS))
    above = sigmas[np.newaxis] >= speeds[:, np.newaxis] / 2
    inside, outside = grid[above], grid[~above]
    near = float((inside < CLOSE_PX).mean())
    below = float((outside < CLOSE_PX).mean()) if outside.size else 0.0
    return ex.Finding(
        interpretation,
        ex.Holds.share(near, 0.95, 0.75),
        f"{near:.0%} of the runs with sigma at or above half the speed have an RMSE below 15 px "
        f"(median {np.median(inside):.1f} px), {below:.0%} of those below it",
    )


EXPERIMENT = ex.Experiment(
    "apf-fig1", "APF, figure 1: the error over sigma and the vehicle's speed", cells, report
)
