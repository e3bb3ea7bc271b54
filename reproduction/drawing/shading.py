# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shading of occlusions, and outlines of lines over scenery."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.patheffects import Normal, Stroke

from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.evaluation.occlusion_stretches import stretches
from vehicle_pf_tracker.evaluation.scores import Scores

_SHADES = {Occlusion.PARTIAL: ("0.93", "partly hidden"), Occlusion.TOTAL: ("0.78", "hidden")}
OUTLINE = (Stroke(linewidth=3.4, foreground="white", alpha=0.8), Normal())
"""White rim that keeps a line visible on any scenery."""


def shade_occlusions(axes: Axes, scores: Scores) -> None:
    """Shade the frames in which the vehicle is partly or totally hidden."""
    truths = {frame.row.frame: frame.truth for frame in scores.frames if frame.truth is not None}
    for occlusion, (shade, label) in _SHADES.items():
        for index, (first, last) in enumerate(stretches(truths, {occlusion})):
            shown = None if index else label
            axes.axvspan(first - 0.5, last + 0.5, color=shade, lw=0, label=shown)
