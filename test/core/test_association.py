# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.association import associate, is_nearest
from vehicle_pf_tracker.core.errors import InputError

MS = 1_000_000
stamps = st.lists(st.integers(0, 60 * MS), max_size=12)


def test_the_limit_itself_is_allowed_and_nothing_beyond():
    assert associate([0], [10 * MS], 0.01) == {0: 0}
    assert associate([0], [10 * MS + 1], 0.01) == {}


def test_the_nearest_goes_first_even_if_another_asked_before():
    # 0 is near both, but 4 is nearer to 5; 0 gets what is left within the limit.
    assert associate([0, 4 * MS], [5 * MS, 9 * MS], 0.01) == {0: 1, 1: 0}


def test_of_equally_close_ones_the_earlier_is_taken():
    assert associate([5], [0, 10], 1.0) == {0: 0}


def test_repeated_stamps_pair_in_order():
    assert associate([7, 7, 7], [7, 7], 0.0) == {0: 0, 1: 1}


def test_many_repeated_stamps_are_quick():
    assert associate([7] * 20_000, [7] * 20_000, 0.0) == {i: i for i in range(20_000)}


def test_nothing_to_pair():
    assert associate([], [1], 1.0) == associate([1], [], 1.0) == {}


@pytest.mark.parametrize("limit", [-0.1, float("nan"), float("inf")])
def test_a_limit_must_be_a_time(limit):
    with pytest.raises(InputError, match="seconds >= 0"):
        associate([1], [1], limit)


def greedy(first, second, limit_ns):
    """The same rule, spelt out: all pairs by difference."""
    candidates = sorted(
        (abs(a - b), i, b, j)
        for i, a in enumerate(first)
        for j, b in enumerate(second)
        if abs(a - b) <= limit_ns
    )
    pairs = {}
    for _, i, _, j in candidates:
        if i not in pairs and j not in pairs.values():
            pairs[i] = j
    return pairs


@given(stamps, stamps, st.integers(0, 30))
def test_agrees_with_trying_all_pairs(first, second, limit_ms):
    assert associate(first, second, limit_ms / 1000) == greedy(first, second, limit_ms * MS)


@pytest.mark.parametrize(
    ("following", "moment", "nearest"),
    [(20, 14, True), (20, 15, True), (20, 16, False), (None, 16, True), (None, 17, False)],
)
def test_a_moment_is_nearest_to_the_first_of_two_stamps_that_are_as_near(
    following, moment, nearest
):
    assert is_nearest(10, following, moment, limit_ns=6) is nearest
