# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figure 2 of the first paper: a frame of the artificial video."""

from __future__ import annotations

from itertools import islice

from matplotlib.figure import Figure

from reproduction import experiment as ex
from reproduction.apf_systems import (
    SETTING,
    VEHICLE_WIDTH,
    artificial_video,
    covered,
)
from reproduction.cells import RunCell
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.scenes.scene import SceneFrame

_WIDTH = 30
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
    shown = next(islice(scene.frames(), stretch[0] - _BEFORE, None))
    rows = tuple(
        (n, *t.box.centre, t.occlusion.name.lower(), t.visible_fraction)
        for n, t in enumerate(truths, start=1)
    )
    hidden = sum(truth.occlusion is Occlusion.TOTAL for truth in truths)
    return ex.Report(
        ex.DataTable(("frame", "x", "y", "occlusion", "visible_fraction"), rows),
        _figure(shown),
        ex.ExperimentVerdict(
            (
                ex.Claim(
                    f"a dark vertical bar of {_WIDTH} px hides the whole vehicle",
                    "section IV, figure 2",
                    (
                        ex.Finding(
                            "our interpretation",
                            ex.Holds.of(hidden > 0),
                            f"less than a tenth of the {VEHICLE_WIDTH:g} px vehicle is seen in "
                            f"{hidden} of {len(truths)} frames, and the bar covers a part of it or "
                            f"all in {stretch[1] - stretch[0] + 1}",
                        ),
                    ),
                ),
            ),
            f"{SETTING} The speed is {choice.speed:g} px/frame.",
        ),
    )


def _figure(shown: SceneFrame) -> Figure:
    height, width = shown.frame.shape[:2]
    figure = Figure(figsize=(5, 5 * height / width + 0.2), layout="constrained")
    axes = figure.add_subplot()
    axes.imshow(shown.frame, extent=(0, width, height, 0))
    x, y = width / 2, height * 0.25
    axes.annotate(
        f"{_WIDTH} px", (x + _WIDTH / 2, y), (x + 70, y), va="center", color="black",
        arrowprops={"arrowstyle": "->", "color": "black"},
    )  # fmt: skip
    axes.set(xlabel="x, px", ylabel="y, px")
    return figure


EXPERIMENT = ex.Experiment(
    "apf-fig2", "APF, figure 2: a frame of the artificial video", cells, report
)
