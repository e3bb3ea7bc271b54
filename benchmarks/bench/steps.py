# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The full step of every variant against OpenCV's trackers, on one vehicle of 40x30 px in VGA."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

from benchmarks.bench.case import Case
from benchmarks.bench.effort import Effort
from benchmarks.bench.turns import Follower, Own, Theirs, follow
from vehicle_pf_tracker.evaluation.baselines import Baseline
from vehicle_pf_tracker.trackers.registry import VARIANTS

BASELINES = ("csrt", "kcf", "mil")
"""OpenCV's trackers that need no network."""


def measure(
    wanted: Callable[[str], bool], effort: Effort, python: Path | None
) -> tuple[list[Case], dict[str, float]]:
    """Measure the cases ``step/VARIANT/BASELINE``, and how long each stayed on the vehicle.

    Raises
    ------
    InputError
        If the interpreter of the baselines, or a baseline, is not there.
    """
    pairs = [
        (own, baseline)
        for own in VARIANTS
        for baseline in BASELINES
        if wanted(f"step/{own}/{baseline}")
    ]
    if not pairs:
        return [], {}
    with contextlib.ExitStack() as stack:
        # Each baseline once, however many variants it is compared with: all take turns.
        followers: dict[str, Follower] = {own: Own(own) for own, _ in pairs}
        for _, baseline in pairs:
            if baseline not in followers:
                followers[baseline] = Theirs(stack.enter_context(Baseline(baseline, python)))
        times, on_target = follow(followers, range(effort.passes), effort.frames)
    cases = [
        Case.of(f"step/{own}/{baseline}", times[own], times[baseline]) for own, baseline in pairs
    ]
    return cases, on_target
