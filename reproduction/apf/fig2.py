# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 2 of the first paper: a frame of the artificial video."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf.systems import (
    BAR_SETTING,
    VEHICLE_WIDTH,
    artificial_video,
    covered,
)
from reproduction.runs.cells import RunCell
from vehicle_pf_tracker.core.truth import TOTAL_BELOW
from vehicle_pf_tracker.scenes.scene import SceneFrame

_WIDTH = 30
"""Width of the bar in the paper's figure, px."""
_BEFORE = 4
"""Frames that the picture is taken before the vehicle reaches the bar."""


def cells(size: ex.Size) -> list[RunCell]:
    """Run nothing: the video alone is shown."""
    return []


def report(results: ex.Results, size: ex.Size) -> ex.Report:
    """Show the frame, and measure bar and occlusion in the truth."""
    choice = artificial_video(_WIDTH)
    truths = choice.truths()
    stretch = covered(truths)
    assert stretch is not None
    scene = choice.make()
    shown = next(scene.frames([stretch[0] - _BEFORE]))
    rows = tuple(
        (n, *t.box.centre, t.occlusion.name.lower(), t.visible_fraction)
        for n, t in enumerate(truths, start=1)
    )
    return ex.Report(
        ex.DataTable(("frame", "x", "y", "occlusion", "visible_fraction"), rows),
        _figure(shown),
        ex.ExperimentVerdict(
            (
                ex.Claim(
                    f"a dark vertical bar of {_WIDTH} px hides the whole vehicle",
                    "section IV, figure 2",
                    (_hides([1.0 if s is None else s for _, _, _, _, s in rows]),),
                    "yes: less than a tenth of the vehicle is seen in a frame; partly: less than "
                    "half of it",
                ),
            ),
            f"{BAR_SETTING} The speed is {choice.speed:g} px/frame.",
        ),
    )


def _hides(visible: Sequence[float]) -> ex.Finding:
    """Judge the visible share of each frame."""
    hidden = sum(share < TOTAL_BELOW for share in visible)
    covered_frames = sum(share < 1 for share in visible)
    return ex.Finding(
        "our interpretation",
        ex.Holds.of(hidden > 0, min(visible) < 0.5),
        f"less than a tenth of the {VEHICLE_WIDTH:g} px vehicle is seen in {hidden} of "
        f"{len(visible)} frames, and the bar covers a part of it or all in {covered_frames}",
    )


def _figure(shown: SceneFrame) -> Figure:
    height, width = shown.frame.shape[:2]
    figure = Figure(figsize=(5, 5 * height / width + 0.2), layout="constrained")
    axes = figure.add_subplot()
    axes.imshow(shown.frame, extent=(0, width, height, 0))
    x, y = width / 2, height * 0.25
    axes.annotate(
        f"{_WIDTH} px",
        (x + _WIDTH / 2, y),
        (x + 70, y),
        va="center",
        color="black",
        arrowprops={"arrowstyle": "->", "color": "black"},
    )
    axes.set(xlabel="x, px", ylabel="y, px")
    return figure


EXPERIMENT = ex.Experiment(
    "apf-fig2", "APF, figure 2: a frame of the artificial video", cells, report
)
