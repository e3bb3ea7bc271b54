# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Annealing rates by hand, and that they give the survival that was asked for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.trackers.papers.sapf import annealing_rate, survival_rate


def test_survival_rate_by_hand():
    # Weights 3 : 1 give D = (3 + 1)² / (9 + 1) = 1.6 of 2; squared, 9 : 1 give 100 / 82.
    log_weights = np.log([3.0, 1.0])
    assert survival_rate(log_weights, 1.0) == pytest.approx(0.8)
    assert survival_rate(log_weights, 2.0) == pytest.approx(50 / 82)
    assert survival_rate(log_weights, 0.0) == pytest.approx(1.0)


def test_survival_rate_does_not_underflow():
    assert survival_rate(np.array([-9000.0, -9000.0, -1e6]), 1.0) == pytest.approx(2 / 3)


def test_annealing_rate_by_hand():
    # Weights 9 : 1 survive at 0.8 when the rate makes them 3 : 1, which is a half.
    assert annealing_rate(np.log([9.0, 1.0]), 0.8, 1.0) == pytest.approx(0.5, rel=1e-3)
    assert annealing_rate(np.log([2.0, 1.0]), 0.8, 10.0) == pytest.approx(
        np.log(3) / np.log(2), rel=1e-3
    )


def test_equal_weights_take_the_largest_rate():
    assert annealing_rate(np.full(7, -3.0), 0.5, 4.0) == 4.0


@given(
    st.lists(st.floats(-50, 0), min_size=2, max_size=60),
    st.floats(0.05, 1.0),
    st.floats(0.1, 1000),
)
def test_the_rate_gives_the_survival_asked_for_or_is_the_largest(log_weights, survival, largest):
    log_weights = np.array(log_weights)
    beta = annealing_rate(log_weights, survival, largest)
    assert 0 <= beta <= largest
    # The rate is found from above, so no more survive than asked for, and hardly fewer.
    assert beta == largest or survival_rate(log_weights, beta) <= survival + 1e-9
    if beta > 1e-9:
        assert survival_rate(log_weights, beta * (1 - 2e-4)) >= survival - 1e-9
