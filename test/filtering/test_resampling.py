# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from vehicle_pf_tracker.filtering.resampling import (
    RESAMPLING_SCHEMES,
    multinomial,
    residual,
    stratified,
    systematic,
)

every_scheme = pytest.mark.parametrize(
    "scheme", RESAMPLING_SCHEMES.values(), ids=RESAMPLING_SCHEMES.keys()
)


class HighestDraw:
    """Stands in for a generator whose every number is the largest below one."""

    def random(self, size=None):
        highest = np.nextafter(1.0, 0.0)
        return highest if size is None else np.full(size, highest)


class LowestDraw:
    def random(self, size=None):
        return 0.0 if size is None else np.zeros(size)


@every_scheme
def test_a_draw_of_zero_steps_over_leading_particles_without_weight(scheme):
    assert scheme(np.array([0.0, 0.5, 0.5]), 3, LowestDraw()).min() == 1


@every_scheme
def test_rounding_never_runs_past_the_last_positive_weight(scheme):
    weights = np.append(np.full(10, 0.1), [0.0, 0.0])
    assert np.cumsum(weights)[-1] < 1.0, "the case is about a sum that rounds below one"
    assert scheme(weights, 10, HighestDraw()).max() == 9


@every_scheme
@pytest.mark.parametrize("useless", [[0.0] * 4, [np.nan] * 4, [np.inf, 0.0, 0.0, 0.0]])
def test_weights_that_say_nothing_count_as_uniform(scheme, useless):
    ancestors = scheme(np.array(useless), 4000, np.random.default_rng(1))
    assert np.bincount(ancestors, minlength=4) / 4000 == pytest.approx(0.25, abs=0.05)


@every_scheme
def test_fewer_and_more_particles_than_before_can_be_drawn(scheme):
    rng = np.random.default_rng(2)
    assert len(scheme(np.full(5, 0.2), 2, rng)) == 2
    assert len(scheme(np.full(5, 0.2), 13, rng)) == 13
    assert len(scheme(np.full(5, 0.2), 0, rng)) == 0


def test_systematic_by_hand():
    # Points 0.125, 0.375, 0.625, 0.875 on cumulative weights 0.1, 0.6, 1.0.
    class Half:
        def random(self, size=None):
            return 0.5

    assert systematic(np.array([0.1, 0.5, 0.4]), 4, Half()).tolist() == [1, 1, 2, 2]


def test_stratified_by_hand():
    class Given:
        def random(self, size=None):
            return np.array([0.0, 0.9, 0.3, 0.1])

    # Points 0, 0.475, 0.575, 0.775.
    assert stratified(np.array([0.1, 0.5, 0.4]), 4, Given()).tolist() == [0, 1, 1, 2]


def test_multinomial_by_hand():
    class Given:
        def random(self, size=None):
            return np.array([0.95, 0.05, 0.1, 0.6])

    # A point that equals a cumulative weight belongs to the next particle.
    assert multinomial(np.array([0.1, 0.5, 0.4]), 4, Given()).tolist() == [2, 0, 1, 2]


def test_residual_keeps_the_whole_part_of_every_expectation():
    weights = np.array([0.3, 0.3, 0.4])
    counts = np.bincount(residual(weights, 10, LowestDraw()), minlength=3)
    assert counts.tolist() == [3, 3, 4]


def test_residual_draws_the_rest_from_the_fractions():
    # Expectations 1.5, 0.5, 0: one copy is certain, the other drawn from fractions 0.5, 0.5.
    ancestors = residual(np.array([0.75, 0.25, 0.0]), 2, HighestDraw())
    assert sorted(ancestors.tolist()) == [0, 1]


@every_scheme
def test_expected_counts_are_proportional_to_the_weights(scheme):
    weights, count, repeats = np.array([0.05, 0.15, 0.3, 0.5]), 40, 500
    rng = np.random.default_rng(3)
    drawn = np.concatenate([scheme(weights, count, rng) for _ in range(repeats)])
    share = np.bincount(drawn, minlength=4) / len(drawn)
    # Five standard errors of the multinomial scheme, which varies most.
    error = np.sqrt(weights * (1 - weights) / (count * repeats))
    assert np.all(np.abs(share - weights) < 5 * error)


@given(
    weights=hnp.arrays(np.float64, st.integers(1, 60), elements=st.floats(0, 1)),
    count=st.integers(1, 80),
    name=st.sampled_from(sorted(RESAMPLING_SCHEMES)),
    seed=st.integers(0, 2**32 - 1),
)
def test_every_draw_is_a_particle_with_weight(weights, count, name, seed):
    ancestors = RESAMPLING_SCHEMES[name](weights, count, np.random.default_rng(seed))
    assert len(ancestors) == count
    assert np.issubdtype(ancestors.dtype, np.integer)
    assert ancestors.min() >= 0
    assert ancestors.max() < len(weights)
    if weights.any():
        assert np.all(weights[ancestors] > 0)


@given(
    weights=hnp.arrays(np.float64, st.integers(1, 40), elements=st.floats(1e-6, 1)),
    count=st.integers(1, 60),
    seed=st.integers(0, 2**32 - 1),
)
def test_systematic_and_residual_stay_within_one_copy_of_the_expectation(weights, count, seed):
    expected = count * weights / weights.sum()
    rng = np.random.default_rng(seed)
    systematic_counts = np.bincount(systematic(weights, count, rng), minlength=len(weights))
    assert np.all(np.abs(systematic_counts - expected) < 1 + 1e-9)
    residual_counts = np.bincount(residual(weights, count, rng), minlength=len(weights))
    assert np.all(residual_counts >= np.floor(expected - 1e-9))


class Given:
    """A source of uniform numbers that are given."""

    def __init__(self, *numbers):
        self.numbers = np.array(numbers)

    def random(self, count):
        assert count == len(self.numbers)
        return self.numbers


def test_stratified_draws_a_number_in_each_stratum():
    # Eight equal weights in four strata of two each: the first or the second of the two.
    drawn = RESAMPLING_SCHEMES["stratified"](np.full(8, 1 / 8), 4, Given(0.1, 0.9, 0.1, 0.9))
    assert drawn.tolist() == [0, 3, 4, 7]


@pytest.mark.parametrize(("point", "last"), [(0.1, 1), (0.5, 2)])
def test_residual_draws_the_rest_by_what_is_left_of_the_expectations(point, last):
    # Expected 2, 1.2 and 0.8 of four: 2, 1 and 0 are certain, 0, 0.2 and 0.8 are left.
    drawn = RESAMPLING_SCHEMES["residual"](np.array([0.5, 0.3, 0.2]), 4, Given(point))
    assert sorted(drawn.tolist()) == [0, 0, 1, last]
