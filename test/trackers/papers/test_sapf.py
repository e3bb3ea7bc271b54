# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The annealed particle filter: its layers, their rates and their diffusion."""

import numpy as np
import pytest
from street import WIDTH, Street, error, follow

from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.papers import colour_tracker
from vehicle_pf_tracker.trackers.papers.sapf import SapfParameters, SapfTracker


def make(**values):
    return SapfTracker(from_mapping(SapfParameters, values))


def test_each_layer_resamples_its_particles():
    estimate = follow(make(**{"annealing.layers": 3}), Street(), range(3))[-1]
    assert estimate.resampling_passes == 3
    assert estimate.resampled_particles == 150
    assert len(estimate.weights) == 50


def test_later_layers_spread_less():
    # Flat weights resample alike in every layer, so that variances add: with sigma 8 and decay 0.5
    # two layers add 64 + 16 to the variance that was there.
    values = {"annealing.decay": 0.5, "annealing.layers": 2, "likelihood.sigma_v": 100.0}
    street = Street(speed=0.0)
    tracker = make(num_particles=20_000, resampling="systematic", **values)
    started = tracker.start(street.frame(0), street.box(0))
    stepped = tracker.step(street.frame(1))
    # Vertically, no particle comes near the border of the image.
    grown = stepped.particles[:, 1].var() - started.particles[:, 1].var()
    assert grown == pytest.approx(80.0, rel=0.1)


def test_the_wanted_share_survives_the_last_layer():
    values = {"annealing.survival": 0.3, "annealing.largest_rate": 1e6}
    for estimate in follow(make(**values), Street(), range(10))[1:]:
        assert estimate.effective_sample_size == pytest.approx(0.3 * 50, rel=0.01)


def test_finds_a_vehicle_that_jumped():
    street = Street(speed=0.0)
    tracker = make()
    follow(tracker, street, range(5))
    far = Street(speed=14.0)
    tracker.step(far.frame(1))
    assert error(tracker.step(far.frame(1)), far, 1) < 6


def test_tied_the_variance_shrinks_by_the_share_that_survives(monkeypatch):
    sigmas, draw = [], colour_tracker.sample_normal
    monkeypatch.setattr(
        colour_tracker,
        "sample_normal",
        lambda rng, n, sigma: sigmas.append(sigma) or draw(rng, n, sigma),
    )
    values = {"annealing.survival": 0.25, "annealing.largest_rate": 1e6, "annealing.layers": 3}
    follow(make(sigma=8.0, **{"annealing.tied": True, **values}), Street(), range(2))
    # The start, then three layers: a quarter of the variance is half of the deviation.
    assert sigmas == pytest.approx([8.0, 8.0, 4.0, 2.0], rel=1e-3)


@pytest.mark.parametrize("left", [True, False])
def test_the_image_is_left_where_the_last_layer_leaves_it(left, monkeypatch):
    tracker = make(**{"annealing.layers": 2})
    tracker.start(Street().frame(0), Street().box(0))
    # The first layer leaves by the near border and the second comes back, or the other way round.
    moves = iter((0.0, -0.5 * WIDTH) if left else (-0.5 * WIDTH, 0.5 * WIDTH))
    monkeypatch.setattr(
        colour_tracker,
        "sample_normal",
        lambda rng, count, sigma: np.full((count, 2), (next(moves), 0.0)),
    )
    estimate = tracker.step(Street(hidden=(0, 99)).frame(1))
    assert estimate.mode is (Mode.LOST if left else Mode.OCCLUDED)
