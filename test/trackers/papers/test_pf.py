# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The colour particle filter of Perez et al. 2002."""

from dataclasses import replace

import numpy as np
import pytest
from street import Street, error, follow

from vehicle_pf_tracker.filtering.resampling import RESAMPLING_SCHEMES
from vehicle_pf_tracker.image.windows.colour import JointColour
from vehicle_pf_tracker.image.windows.similarity import Reference
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.papers import colour_tracker
from vehicle_pf_tracker.trackers.papers.pf import PfParameters, PfTracker


def make(**values):
    return PfTracker(from_mapping(PfParameters, values))


def test_weights_are_perez_exponential_of_the_squared_distance():
    street = Street()
    tracker = make(num_particles=50)
    estimate = follow(tracker, street, range(2))[-1]
    reference = Reference(tracker.target.joint_histogram(tracker.window, 3))
    rho = JointColour(3).similarity(street.frame(1), estimate.particles, tracker.window, reference)
    # sigma_v 0.158 is a lambda of 20.03: exp(-lambda d²) with d² = 1 - rho.
    expected = np.exp(-(1 - rho) / (2 * 0.158**2))
    assert estimate.weights == pytest.approx(expected / expected.sum())
    mean = (estimate.weights[:, None] * estimate.particles).sum(axis=0)
    assert estimate.position == pytest.approx(tuple(mean))


def test_it_stays_behind_where_the_vehicle_vanished():
    street = Street(speed=3.0, hidden=(15, 40))
    estimates = follow(make(sigma=3.0), street, range(50))
    assert error(estimates[14], street, 14) < 6
    assert error(estimates[-1], street, 49) > 40


SECOND_ORDER = {"dynamics": "second_order", "resampling": "systematic"}


def test_second_order_particles_go_on_with_their_ancestors_moves(monkeypatch):
    moves = np.array([[1.0, 0.0], [2.0, 3.0], [-1.0, 4.0]])
    street, tracker = Street(speed=0.0), make(num_particles=3, **SECOND_ORDER)
    started = tracker.start(street.frame(0), street.box(0)).particles
    monkeypatch.setitem(RESAMPLING_SCHEMES, "systematic", lambda *_: np.array([0, 1, 2]))
    monkeypatch.setattr(colour_tracker, "sample_normal", lambda rng, count, sigma: moves)
    first = tracker.step(street.frame(1)).particles
    assert first == pytest.approx(started + moves)
    monkeypatch.setitem(RESAMPLING_SCHEMES, "systematic", lambda *_: np.array([1, 1, 2]))
    monkeypatch.setattr(colour_tracker, "sample_normal", lambda rng, count, sigma: np.zeros((3, 2)))
    # Two periods: twice the ancestor's own last move of one.
    second = tracker.step(street.frame(2), 2.0).particles
    assert second == pytest.approx(first[[1, 1, 2]] + 2 * moves[[1, 1, 2]])
    third = tracker.step(street.frame(3)).particles
    assert third == pytest.approx(second[[1, 1, 2]] + moves[[1, 1, 2]])


def test_another_number_of_particles_all_have_the_mean_speed(monkeypatch):
    chosen = lambda weights, count, rng: np.arange(count) % len(weights)  # noqa: E731
    monkeypatch.setitem(RESAMPLING_SCHEMES, "systematic", chosen)
    street, tracker = Street(), make(num_particles=3, **SECOND_ORDER)
    *_, before, last = (estimate.particles for estimate in follow(tracker, street, range(3)))
    tracker.reconfigure(replace(tracker.parameters, num_particles=5))
    monkeypatch.setattr(
        colour_tracker, "sample_normal", lambda rng, count, sigma: np.zeros((count, 2))
    )
    moves = tracker.step(street.frame(3)).particles - last[[0, 1, 2, 0, 1]]
    assert moves == pytest.approx(np.array([(last - before).mean(axis=0)] * 5))
    tracker.reconfigure(replace(tracker.parameters, sigma=3.0))
    assert len(tracker.step(street.frame(4)).particles) == 5
