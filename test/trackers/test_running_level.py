# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The usual level of a measurement, by hand."""

import pytest

from vehicle_pf_tracker.trackers.evidence import RunningLevel


def level_of(*values, rate=0.5):
    level = RunningLevel()
    for value in values:
        level.add(value, rate)
    return level


def test_the_first_value_is_the_level_and_says_nothing_about_the_deviation():
    level = level_of(0.8)
    assert (level.value, level.deviation, level.count) == (0.8, 0.05, 1)


def test_the_first_values_count_alike_and_later_ones_by_the_rate():
    assert level_of(1.0, 0.0, 0.5, rate=0.1).value == pytest.approx(0.5)
    level = level_of(*[0.5] * 20, rate=0.1)
    level.add(1.5, 0.1)
    assert level.value == pytest.approx(0.6)


def test_the_deviation_follows_the_distance_to_the_level_before():
    # 0.1 away from a level of 0.8 is twice the deviation of 0.05, and counts in full.
    assert level_of(0.8, 0.7).deviation == pytest.approx(0.075)
    assert level_of(0.8, 0.78).deviation == pytest.approx(0.035)


@pytest.mark.parametrize("far", [0.69, 0.1, -5.0])
def test_a_value_counts_as_two_deviations_at_most(far):
    assert level_of(0.8, far).deviation == pytest.approx(0.075)
