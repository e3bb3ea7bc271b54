# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A car that is followed with a box a fifth too large."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from fusion_samples import driven, fusion

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.fusion.follow import follow
from vehicle_pf_tracker.trackers.fusion.schedule import Tasks
from vehicle_pf_tracker.trackers.fusion.step import Observation, Step
from vehicle_pf_tracker.trackers.fusion.verdict import Visible

LAST = 10


@pytest.fixture(scope="module")
def tracker():
    tracker = fusion()
    tracker.start(driven(0), Box(60, 100, 64, 30))
    for time in range(1, LAST + 1):
        tracker.step(driven(time), 1.0)
    return tracker


def followed(tracker, response, *, known):
    """Ratio of the size after a frame of this response to that before, with a known background."""
    state = tracker.state._replace(size=1.2 * tracker.state.size)
    foreground = SimpleNamespace(is_known=known, around=lambda position, size: None)
    memory = replace(tracker.memory, foreground=foreground)
    rng = np.random.default_rng(0)
    step = Step(driven(LAST), 1.0, tracker.parameters, rng, memory, Tasks(), 1 / 30)
    view = memory.appearance.view(memory.appearance.patch(step.frame, state.position, state.size))
    seen = Observation(view, state.position, response, False, Tasks(follows_size=True))
    after = follow(state, Visible(1.0), seen, step)
    return after.size / state.size


@pytest.mark.parametrize(
    ("known", "response", "is_measured"),
    [(True, 0.65, True), (False, 0.65, False), (False, 0.75, True), (True, 0.55, False)],
)
def test_a_size_is_measured_above_a_response(tracker, known, response, is_measured):
    """Where no background is known it may turn below .7, and the filter know a part only."""
    ratio = followed(tracker, response, known=known)
    assert (ratio < 0.995).any() == is_measured
    if not is_measured:
        assert ratio == pytest.approx(1)
