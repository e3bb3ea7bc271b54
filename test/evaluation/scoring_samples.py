# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Estimates and truth with numbers that can be checked by hand."""

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.scores import FrameScore, Scores
from vehicle_pf_tracker.results.estimates import EstimateRow

NONE, PARTIAL, TOTAL = Occlusion.NONE, Occlusion.PARTIAL, Occlusion.TOTAL
SIDES = (24.0, 32.0)  # diagonal 40: on target below 20 px
PERIOD_NS = 100_000_000


def row(frame, x, y=100.0, mode="TRACKING", step_ms=1.0):
    return EstimateRow(frame, frame * PERIOD_NS, x, y, *SIDES, mode, 1.0, 50.0, step_ms)


def truth(frame, occlusion=NONE, centre=(100.0, 100.0), sides=SIDES):
    return Truth(frame * PERIOD_NS, Box.around(centre, *sides), occlusion)


def scored(frame, error, occlusion=NONE, mode="TRACKING", sides=SIDES):
    """A frame whose estimate is `error` px to the right of the truth; None has no estimate."""
    if error is None:
        estimate = EstimateRow.without(frame, frame * PERIOD_NS, mode)
    else:
        estimate = row(frame, 100.0 + error, mode=mode)
    return FrameScore(estimate, truth(frame, occlusion, sides=sides))


def run_of(*parts):
    """Scores of stretches given as (count, error, occlusion), frames counted from 1."""
    frames = []
    for count, error, occlusion in parts:
        frames += [scored(len(frames) + 1 + i, error, occlusion) for i in range(count)]
    return Scores(tuple(frames))
