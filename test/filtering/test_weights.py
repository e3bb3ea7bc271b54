# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from vehicle_pf_tracker.filtering.weights import effective_sample_size, from_log, normalise


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        ([1.0, 3.0], [0.25, 0.75]),
        ([5e-324, 1e-323], [1 / 3, 2 / 3]),
        ([1.5e308, 0.75e308, 0.75e308], [0.5, 0.25, 0.25]),
    ],
    ids=["plain", "too small to add up", "too large to add up"],
)
def test_normalise_keeps_ratios(raw, expected):
    weights, sound = normalise(np.array(raw))
    assert sound
    assert weights == pytest.approx(expected)


@pytest.mark.parametrize(
    "useless",
    [[0.0, 0.0], [np.nan, 1.0], [np.inf, 1.0], [-1.0, 2.0], [-np.inf, 1.0]],
    ids=["zero", "nan", "infinite", "negative", "minus-infinite"],
)
def test_weights_without_information_become_uniform_and_are_reported(useless):
    weights, sound = normalise(np.array(useless))
    assert not sound
    assert weights.tolist() == [0.5, 0.5]


def test_logarithms_do_not_underflow():
    weights, sound = from_log(np.array([-5000.0, -5000.0 + np.log(3.0)]))
    assert sound
    assert weights == pytest.approx([0.25, 0.75])


def test_logarithms_of_nothing_are_uniform_and_told():
    weights, sound = from_log(np.array([-np.inf, -np.inf]))
    assert not sound
    assert weights.tolist() == [0.5, 0.5]


@pytest.mark.parametrize(
    ("weights", "expected"),
    [
        ([0.25, 0.25, 0.25, 0.25], 4.0),
        ([1.0, 0.0, 0.0, 0.0], 1.0),
        ([0.5, 0.5, 0.0], 2.0),
        ([0.5, 0.25, 0.25], 1 / 0.375),
    ],
    ids=["uniform", "one", "two-of-three", "uneven"],
)
def test_effective_sample_size_by_hand(weights, expected):
    assert effective_sample_size(np.array(weights)) == pytest.approx(expected)


@given(hnp.arrays(np.float64, st.integers(1, 50), elements=st.floats(0, 1e300)))
def test_normalised_weights_sum_to_one_and_n_eff_is_between_one_and_n(raw):
    weights, _ = normalise(raw)
    assert weights.sum() == pytest.approx(1.0)
    assert 1 - 1e-9 <= effective_sample_size(weights) <= len(raw) + 1e-6


def test_a_weight_of_zero_is_as_sound_as_any():
    weights, sound = normalise(np.array([0.0, 3.0, 1.0]))
    assert sound
    assert weights.tolist() == [0.0, 0.75, 0.25]
