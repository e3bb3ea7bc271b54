# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Table of decisions, each judged on every camera by the value that is best for the others."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence

from laboratory.traffic.decisions import Decision
from vehicle_pf_tracker.evaluation.tables import NO_SCORE

HEADER = [
    "decision",
    "shipped",
    "by the other cameras",
    "left out",
    "shipped scores",
    "without",
    "worth",
]
"""Headings; *by the other cameras* has the values that are best for them, in the order of the
cameras, *left out* the mean of what each scores on the camera that it has not seen; *worth* is what
the shipped value scores more than none, mean and standard error over the cameras."""


def row(decision: Decision, scores: Mapping[float, Mapping[str, float]]) -> list[str]:
    """Summarise one decision."""
    shipped = next(iter(scores))
    # Without the decision is no candidate: it shows what the decision is worth.
    candidates = [value for value in scores if value != decision.without or value == shipped]
    cameras = list(scores[shipped])
    chosen = {camera: best_for_others(scores, candidates, camera) for camera in cameras}
    seen = statistics.fmean(scores[shipped].values())
    left_out = statistics.fmean(scores[value][camera] for camera, value in chosen.items())
    without = worth = NO_SCORE
    if decision.without is not None:
        none = scores[decision.without]
        without = f"{statistics.fmean(none.values()):.1f}"
        worth = mean_and_error([scores[shipped][camera] - none[camera] for camera in cameras])
    values = ", ".join(f"{value:g}" for value in chosen.values())
    judged = (f"{left_out:.1f}", f"{seen:.1f}", without, worth)
    return [decision.place, f"{shipped:g}", values, *judged]


def mean_and_error(differences: Sequence[float]) -> str:
    """Return the mean of paired differences, and its standard error where there are several."""
    mean = f"{statistics.fmean(differences):+.1f}"
    if len(differences) < 2:
        return mean
    return f"{mean} ± {statistics.stdev(differences) / len(differences) ** 0.5:.1f}"


def best_for_others(
    scores: Mapping[float, Mapping[str, float]], values: Sequence[float], camera: str
) -> float:
    """Return the value with the best mean over all other cameras; the first of equal ones."""

    def others(value: float) -> float:
        # With a single camera nothing is left to decide by: the shipped value, which is first.
        each = [score for name, score in scores[value].items() if name != camera]
        return statistics.fmean(each) if each else 0.0

    return max(values, key=others)
