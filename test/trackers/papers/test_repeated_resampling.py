# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""P3, Tables I and II, and each of their interpretations."""

import numpy as np
import pytest
from street import Street, follow

from vehicle_pf_tracker.filtering.resampling import RESAMPLING_SCHEMES
from vehicle_pf_tracker.filtering.weights import effective_sample_size
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.base import Cloud
from vehicle_pf_tracker.trackers.papers import repeated_resampling
from vehicle_pf_tracker.trackers.papers.repeated_resampling import (
    AdaptiveParameters,
    AdaptiveTracker,
    ConventionalParameters,
    ConventionalTracker,
    WeighedParticles,
)


def conventional(**values):
    return ConventionalTracker(from_mapping(ConventionalParameters, values))


def adaptive(**values):
    return AdaptiveTracker(from_mapping(AdaptiveParameters, values))


both = pytest.mark.parametrize("make", [conventional, adaptive])


def count_weighings(tracker):
    """Make the tracker write down how many windows each call compares."""
    sizes, compare = [], tracker.similarity
    tracker.similarity = lambda frame, positions: (
        sizes.append(len(positions)) or compare(frame, positions)
    )
    return sizes


@both
def test_the_counts_are_the_likelihoods_that_were_evaluated(make):
    street, tracker = Street(), make()
    tracker.start(street.frame(0), street.box(0))
    for time in range(1, 10):
        sizes = count_weighings(tracker)
        estimate = tracker.step(street.frame(time))
        del tracker.similarity
        # The first weighing takes all particles, the last the estimate alone.
        assert (sizes[0], sizes[-1]) == (200, 1)
        assert estimate.resampling_passes == len(sizes) - 2
        assert estimate.resampled_particles == sum(sizes[1:-1])


@both
def test_repeats_until_the_criterion_or_the_cap(make):
    estimates = follow(make(criterion=0.95), Street(), range(20))[1:]
    assert max(e.resampling_passes for e in estimates) > 1
    for estimate in estimates:
        enough = estimate.effective_sample_size >= 0.95 * 200
        assert enough or estimate.resampling_passes == 20


@both
def test_interpretation_21_the_printed_criterion_is_never_reached(make):
    estimates = follow(make(as_printed=True), Street(), range(6))[1:]
    assert {e.resampling_passes for e in estimates} == {20}


def test_adaptive_weighs_far_fewer_again():
    street, times = Street(), range(40)
    spent = [
        sum(e.resampled_particles for e in follow(make(), street, times))
        for make in (conventional, adaptive)
    ]
    assert spent[1] < spent[0] / 5


def one_pass(coefficients, **values):
    """Do one pass of `adaptive` on particles 1 px apart; returns what was before and after."""
    street, tracker = Street(), adaptive(num_particles=len(coefficients), **values)
    tracker.start(street.frame(0), street.box(0))
    positions = np.column_stack(
        [20.0 + np.arange(len(coefficients)), np.full(len(coefficients), 50)]
    )
    before = tracker.weigh(positions, np.asarray(coefficients))
    return before, *tracker.resample_once(street.frame(0), before, 1.0)


def test_only_particles_below_the_mean_weight_are_replaced():
    before, after, replaced, regime = one_pass([0.99, 0.2, 0.99, 0.3, 0.99, 0.99])
    kept = [0, 2, 4, 5]
    assert (replaced, regime) == (2, "regular")
    assert np.array_equal(after.cloud.positions[kept], before.cloud.positions[kept])
    assert np.array_equal(after.coefficients[kept], before.coefficients[kept])
    assert not np.any(after.cloud.positions[[1, 3]] == before.cloud.positions[[1, 3]])


def test_under_occlusion_only_the_best_particle_stays_and_the_rest_gathers_around_it():
    before, after, replaced, regime = one_pass([0.2] * 9 + [0.99] + [0.2] * 30)
    assert (replaced, regime) == (39, "occlusion")
    assert np.array_equal(after.cloud.positions[9], before.cloud.positions[9])
    # 0.25 of a sigma of 14 px.
    assert np.std(after.cloud.positions - before.cloud.positions[9]) == pytest.approx(3.5, rel=0.3)


def test_interpretation_22_the_test_by_similarity_ignores_peaked_weights():
    _, _, _, regime = one_pass([0.2] * 9 + [0.99] + [0.2] * 30, **{"occlusion.test": "similarity"})
    assert regime == "regular"


def test_interpretation_22_the_test_by_similarity_sees_that_nothing_is_like_the_vehicle():
    street, tracker = Street(), adaptive(**{"occlusion.test": "similarity"})
    follow(tracker, street, range(10))
    unlike = tracker.weigh(np.full((5, 2), 50.0), np.array([0.1, 0.2, 0.3, 0.2, 0.1]))
    alike = tracker.weigh(np.full((5, 2), 50.0), np.array([0.1, 0.2, 0.95, 0.2, 0.1]))
    assert tracker.resample_once(street.frame(9), unlike, 1.0)[2] == "occlusion"
    assert tracker.resample_once(street.frame(9), alike, 1.0)[2] == "regular"


def test_interpretation_23_copies_are_jittered_by_a_share_of_sigma():
    tracker, street = conventional(sigma=10.0, jitter=0.3, num_particles=4000), Street()
    tracker.start(street.frame(0), street.box(0))
    positions = np.tile([100.0, 60.0], (4000, 1))
    particles = WeighedParticles(np.full(4000, 0.9), Cloud.uniform(positions))
    after, replaced, _ = tracker.resample_once(street.frame(0), particles, 2.0)
    assert replaced == 4000
    # 0.3 of 10 px a frame, in two frames.
    assert np.std(after.cloud.positions - positions) == pytest.approx(6.0, rel=0.05)


@pytest.mark.parametrize("recursion", [True, False])
def test_interpretation_40_a_frame_without_a_pass_goes_on_with_its_weights_or_without(recursion):
    street, tracker = Street(), adaptive(criterion=0.0, weight_recursion=recursion)
    before = follow(tracker, street, range(4))[-1]
    estimate = tracker.step(street.frame(4))
    assert estimate.resampling_passes == before.resampling_passes == 0
    rho = tracker.similarity(street.frame(4), estimate.particles)
    # Of sigma_v 0.2: (1 - rho) / (2 * 0.04).
    logs = (np.log(before.weights) if recursion else 0.0) - (1 - rho) / 0.08
    weights = np.exp(logs - logs.max())
    assert estimate.weights == pytest.approx(weights / weights.sum(), rel=1e-3, abs=1e-9)


def test_interpretation_40_without_a_pass_the_printed_measurement_has_no_effect_at_all():
    street, blind = Street(hidden=(1, 99)), Street()
    settings = {"criterion": 0.0, "weighted_mean": False}
    positions = [
        [e.position for e in follow(adaptive(**settings), one, range(12))]
        for one in (street, blind)
    ]
    assert positions[0] == positions[1]


def test_the_plain_mean_as_printed():
    estimate = follow(adaptive(weighted_mean=False), Street(), range(5))[-1]
    assert estimate.position == pytest.approx(tuple(estimate.particles.mean(axis=0)))
    assert estimate.effective_sample_size == pytest.approx(
        effective_sample_size(np.asarray(estimate.weights))
    )
    weighted = follow(adaptive(), Street(), range(5))[-1]
    assert weighted.position == pytest.approx(tuple(weighted.weights @ weighted.particles))


def test_the_limit_of_low_weights_is_a_multiple_of_the_mean_weight():
    # Weights exp(-(1 - rho) / 0.08) of 0.88, 0.69 and about 0: 1.7, 1.3 and 0 of the mean weight.
    coefficients = [0.99, 0.97, 0.2, 0.97, 0.99, 0.2]
    assert [one_pass(coefficients, low_weight=limit)[2] for limit in (1.0, 1.5)] == [2, 4]


def test_copies_are_made_of_kept_particles_only():
    before, after, replaced, _ = one_pass(
        [0.99, 0.97, 0.97, 0.97, 0.97, 0.97], low_weight=1.2, jitter=0.0
    )
    assert replaced == 5
    assert np.array_equal(after.cloud.positions, np.tile(before.cloud.positions[0], (6, 1)))


def test_copies_are_made_of_the_kept_in_proportion_to_their_weights():
    # Of sigma_v 0.2: coefficients 0.08 ln 3 apart have weights 3 : 1, here 0.75 and 0.25.
    coefficients = [0.99, 0.99 - 0.08 * np.log(3), *[0.01] * 8]
    values = {"resampling": "systematic", "jitter": 0.0, "occlusion.n_eff": 0.0}
    before, after, replaced, regime = one_pass(coefficients, **values)
    assert (replaced, regime) == (8, "regular")
    first, second = (
        (after.cloud.positions == before.cloud.positions[which]).all(axis=1).sum()
        for which in (0, 1)
    )
    assert (first, second) == (1 + 6, 1 + 2)


def test_particles_of_equal_weight_are_all_good():
    before, after, replaced, _ = one_pass([0.9] * 5)
    assert replaced == 0
    assert after is before


@both
def test_the_plain_mean_leaves_the_particles_their_weights(make):
    street, tracker = Street(), make(weighted_mean=False, most_passes=0)
    tracker.start(street.frame(0), street.box(0))
    estimate = tracker.step(street.frame(1))
    assert estimate.position == pytest.approx(estimate.particles.mean(axis=0))
    assert np.ptp(estimate.weights) > 0


def test_the_conventional_filter_replaces_all_in_the_regular_regime(monkeypatch):
    drawn_by, spreads = [], []

    def in_order(weights, count, rng):
        drawn_by.append(weights.tolist())
        return np.arange(count)

    def apart(rng, count, sigma):
        spreads.append(sigma)
        return np.ones((count, 2))

    monkeypatch.setitem(RESAMPLING_SCHEMES, "systematic", in_order)
    monkeypatch.setattr(repeated_resampling, "sample_normal", apart)
    street, tracker = Street(), conventional(sigma=10.0, resampling="systematic")
    tracker.start(street.frame(0), street.box(0))
    positions = np.array([[20.0, 50.0], [30.0, 50.0], [40.0, 60.0]])
    spreads.clear()
    before = tracker.weigh(positions, np.full(3, 0.9))
    after, replaced, regime = tracker.resample_once(street.frame(0), before, 1.0)
    assert (replaced, regime) == (3, "regular")
    assert np.array_equal(after.cloud.positions, positions + 1.0)
    assert (drawn_by, spreads) == ([pytest.approx([1 / 3] * 3)], [0.5 * 10.0])
