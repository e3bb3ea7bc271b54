# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mean shift as a tracker: certain, short of memory, and bound to where it was."""

import pytest
from street import SIZE, Street, error, follow

from vehicle_pf_tracker.parameters.table import from_mapping, specs
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.papers.ms import MsParameters, MsTracker


def make(**values):
    return MsTracker(from_mapping(MsParameters, values))


def test_its_cloud_is_its_position():
    for estimate in follow(make(), Street(), range(5)):
        assert tuple(estimate.particles[0]) == pytest.approx(estimate.position)
        assert estimate.weights.tolist() == [1.0]
        assert estimate.effective_sample_size == 1.0
        assert estimate.resampling_passes == 0
    assert "num_particles" not in specs(MsParameters)


def test_steps_until_a_step_is_short():
    # From 10 px away one step does not arrive, fifteen do.
    street, away = Street(speed=0.0), Street(speed=10.0)
    errors = []
    for values in ({"iterations": 1}, {"iterations": 15}, {"shortest_step": 100.0}):
        tracker = make(**values)
        tracker.start(street.frame(0), street.box(0))
        errors.append(error(tracker.step(away.frame(1)), away, 1))
    assert errors[1] < 1.5
    assert errors[0] > errors[1]
    assert errors[2] == errors[0]


def test_a_vehicle_out_of_the_windows_reach_is_not_found_and_not_claimed():
    street = Street(speed=0.0)
    tracker = make()
    follow(tracker, street, range(8))
    gone = Street(speed=2.0 * SIZE[0])
    estimate = tracker.step(gone.frame(1))
    assert error(estimate, gone, 1) > SIZE[0]
    assert estimate.mode is Mode.OCCLUDED
