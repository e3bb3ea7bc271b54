# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Occlusions shaded in figures over frames."""

from matplotlib.figure import Figure

from reproduction.drawing.shading import shade_occlusions
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.scores import FrameScore, Scores
from vehicle_pf_tracker.results.estimates import EstimateRow

NONE, PARTIAL, TOTAL = Occlusion.NONE, Occlusion.PARTIAL, Occlusion.TOTAL


def scores_of(*occlusions):
    """Scores of frames, counted from 1, whose truths have these occlusions."""
    box = Box(100, 60, 20, 10)
    return Scores(
        tuple(
            FrameScore(EstimateRow.without(n, n, "TRACKING"), Truth(n, box, occlusion))
            for n, occlusion in enumerate(occlusions, start=1)
        )
    )


def test_occlusions_are_shaded_once():
    axes = Figure().add_subplot()
    shade_occlusions(axes, scores_of(*[NONE] * 10, *[PARTIAL] * 4, *[TOTAL] * 6, *[NONE] * 10))
    spans = [
        (patch.get_label(), patch.get_extents().transformed(axes.transData.inverted()))
        for patch in axes.patches
    ]
    found = {label: (round(box.x0, 3), round(box.x1, 3)) for label, box in spans}
    assert found == {"partly hidden": (10.5, 14.5), "hidden": (14.5, 20.5)}
    assert len(spans) == 2
