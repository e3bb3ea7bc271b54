# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.evaluation.statistics import Summary, summarise


def test_mean_and_spread_by_hand():
    summary = summarise([2.0, 4.0, 9.0])
    assert (summary.count, summary.mean) == (3, 5)
    assert summary.spread == pytest.approx(np.sqrt((9 + 1 + 16) / 2))
    assert 2 <= summary.low < 5 < summary.high <= 9


def test_one_value_has_no_spread_and_none_have_no_summary():
    assert summarise([7.0]) == Summary(1, 7.0, None, None, None)
    assert summarise([]) is None


def test_equal_values_have_an_interval_without_width():
    assert summarise([3.0, 3.0, 3.0]) == Summary(3, 3.0, 0.0, 3.0, 3.0)


def test_the_same_values_have_the_same_interval():
    values = [1.0, 2.0, 4.0, 8.0, 16.0]
    assert summarise(values) == summarise(values)


def test_the_interval_covers_the_true_mean_about_as_often_as_it_says():
    rng = np.random.default_rng(5)
    samples = rng.exponential(1.0, (80, 40))  # true mean 1
    summaries = [summarise(list(sample)) for sample in samples]
    covered = np.mean([s.low <= 1 <= s.high for s in summaries])
    assert 0.85 <= covered <= 0.99


@settings(max_examples=20)
@given(st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=8))
def test_the_interval_stays_within_the_values(values):
    summary = summarise(values)
    slack = 1e-9 * max(map(abs, values))
    assert min(values) - slack <= summary.low <= summary.high <= max(values) + slack
