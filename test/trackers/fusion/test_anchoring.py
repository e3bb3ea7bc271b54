# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A car of 64 x 30 px, of which only the left 48 px are followed, and then all of it."""

import numpy as np
import pytest
from fusion_samples import driven, fusion

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.fusion.anchoring import anchored
from vehicle_pf_tracker.trackers.fusion.schedule import Tasks
from vehicle_pf_tracker.trackers.fusion.sides import moved_box
from vehicle_pf_tracker.trackers.fusion.step import Step

BEYOND = np.array([[0.0, 0.0], [1 / 3, 0.0]])
LAST = 10


def followed():
    """A tracker of its left three quarters."""
    tracker = fusion()
    tracker.start(driven(0), Box(60, 100, 48, 30))
    for time in range(1, LAST + 1):
        tracker.step(driven(time), 1.0)
    return tracker


def moved(state):
    """The box of all of the car."""
    return moved_box(state.position, state.size, BEYOND)


def step_of(tracker):
    rng = np.random.default_rng(0)
    return Step(driven(LAST), 1.0, tracker.parameters, rng, tracker.memory, Tasks(), 1 / 30)


def test_all_that_was_measured_in_the_box_moves_with_it():
    tracker = followed()
    before = tracker.state
    after = anchored(before, moved(before), step_of(tracker))
    shift = np.array([before.size[0] / 6, 0])
    assert after.position == pytest.approx(before.position + shift)
    assert after.size == pytest.approx(before.size * [4 / 3, 1])
    assert after.particles.mean == pytest.approx(before.particles.mean + shift)
    assert after.particles.mean_velocity == pytest.approx(before.particles.mean_velocity)
    last = after.sightings.rows[-1]
    assert last[1:3] == pytest.approx(after.position)
    assert last[3:5] == pytest.approx(after.size)
    # It is the vehicle's box now: no side is known to be anywhere else.
    assert not after.sides.beyond.any()


def test_the_filter_keeps_the_box_where_it_was_moved_to():
    tracker = followed()
    tracker.state = anchored(tracker.state, moved(tracker.state), step_of(tracker))
    for time in range(LAST + 1, LAST + 9):
        estimate = tracker.step(driven(time), 1.0)
    # Its middle is 32 px from its left side, at 60 + 2 * 18; without, it would be 24 px.
    assert estimate.box.x + estimate.box.width / 2 == pytest.approx(96 + 32, abs=2)
    assert estimate.box.width == pytest.approx(64, abs=4)
    assert estimate.confidence > 0.9
