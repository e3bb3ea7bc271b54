# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Objective that a setting of `fusion` is fitted by, of a run and of a camera."""

from __future__ import annotations

import statistics
from collections.abc import Sequence

from laboratory.stress import Result, Score


def objective(score: Score) -> float:
    """On target plus overlap plus occlusions recovered, less frames of a wrong mode; all shares.

    Without the mode, settings that doubt a tenth of the visible frames are as good as any.
    """
    value = (score.on_target or 0.0) + (score.mean_iou or 0.0)
    value -= (score.doubted or 0.0) + (score.claimed_hidden or 0.0)
    # Without a judged occlusion the share is full: cases without one differ by the rest alone.
    return value + (score.recovered / score.judged if score.judged else 1.0)


def camera_means(results: Sequence[Result]) -> dict[str, float]:
    """Mean objective of each camera, over kinds of cases and then over these."""
    cameras = dict.fromkeys(result.case.camera for result in results)
    means = {}
    for camera in cameras:
        own = [result for result in results if result.case.camera == camera]
        kinds = dict.fromkeys(result.case.kind for result in own)
        # Kinds weigh alike, however many cases of each a sequence gives.
        means[camera] = statistics.fmean(
            statistics.fmean(objective(r.score) for r in own if r.case.kind == kind)
            for kind in kinds
        )
    return means
