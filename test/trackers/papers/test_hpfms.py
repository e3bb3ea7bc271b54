# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The hybrid of particle filter and mean shift: refined particles, adaptive spread."""

import numpy as np
import pytest
from street import Street, follow

from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.papers.hpfms import HpfmsParameters, HpfmsTracker


def make(**values):
    return HpfmsTracker(from_mapping(HpfmsParameters, values))


def spread(estimate):
    return float(estimate.particles.std(axis=0).mean())


def test_mean_shift_gathers_the_particles_on_the_vehicle():
    street, times = Street(), range(20)
    spreads = [
        np.mean([spread(e) for e in follow(make(iterations=count), street, times)[5:]])
        for count in (0, 1, 3)
    ]
    assert spreads[0] > spreads[1] > spreads[2]


def test_the_spread_follows_the_speed():
    # Twelve px a frame are more than sigma, two are less.
    values = {"sigma": 5.0, "transition.widest": 1.0}
    slow, fast = make(**values), make(**values)
    follow(slow, Street(speed=2.0), range(12))
    follow(fast, Street(speed=8.0), range(12))
    assert slow.spread() == pytest.approx(5.0)
    assert fast.spread() == pytest.approx(8.0, rel=0.1)
    half = make(**{"sigma": 1.0, "transition.widest": 1.0, "transition.speed_share": 0.5})
    follow(half, Street(speed=8.0), range(12))
    assert half.spread() == pytest.approx(4.0, rel=0.1)


def test_the_spread_grows_with_doubt_up_to_its_bound():
    values = {"sigma": 5.0, "transition.speed_share": 0.0, "transition.widest": 2.0}
    tracker = make(**values)
    street = Street(speed=0.0, hidden=(15, 99))
    tracker.start(street.frame(0), street.box(0))
    assert tracker.spread() == pytest.approx(10.0)  # nothing is known of the speed yet
    for time in range(1, 15):
        tracker.step(street.frame(time))
    assert tracker.spread() == pytest.approx(5.0, rel=0.1)
    tracker.step(street.frame(15))
    assert tracker.spread() == pytest.approx(10.0)


def test_without_mean_shift_the_moves_have_the_spread():
    values = {"sigma": 4.0, "transition.speed_share": 0.0, "transition.widest": 1.0}
    tracker = make(num_particles=20_000, iterations=0, **values, **{"likelihood.sigma_v": 100.0})
    street = Street(speed=0.0)
    started = tracker.start(street.frame(0), street.box(0))
    stepped = tracker.step(street.frame(1))
    # Flat weights: 16 px² are added to the 16 that were there.
    assert started.particles[:, 1].var() == pytest.approx(16.0, rel=0.05)
    assert stepped.particles[:, 1].var() == pytest.approx(32.0, rel=0.05)
