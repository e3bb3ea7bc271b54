# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

from vehicle_pf_tracker.trackers.papers.shared import MeanVelocity


def moved(velocity, *steps):
    """Add displacements along x, one frame each."""
    x = 0.0
    for step in steps:
        velocity.add((x, 0.0), (x + step, 0.0), 1.0)
        x += step
    return velocity


def test_the_newest_moves_do_not_count_for_the_settled_velocity():
    velocity = moved(MeanVelocity(3, delay=2), 1, 2, 3, 4, 50, 60)
    assert velocity.value == (pytest.approx((4 + 50 + 60) / 3), 0.0)
    assert velocity.settled == (pytest.approx((2 + 3 + 4) / 3), 0.0)


def test_with_few_moves_the_older_half_counts():
    velocity = MeanVelocity(8, delay=12)
    assert velocity.settled == (0.0, 0.0)
    assert moved(velocity, 5).settled == (5.0, 0.0)
    assert moved(MeanVelocity(8, delay=12), 1, 2, 90, 90).settled == (1.5, 0.0)


def test_over_all_moves_the_newest_wait_as_well():
    velocity = moved(MeanVelocity(0, delay=1), 1, 2, 3, 100)
    assert velocity.settled == (2.0, 0.0)
    assert velocity.value == (26.5, 0.0)


def test_months_of_moves_keep_nothing_but_the_window():
    velocity = moved(MeanVelocity(4, delay=2), *range(10_000))
    assert len(velocity.moves) == 6
    assert velocity.value[0] == pytest.approx(9997.5)
    assert len(moved(MeanVelocity(0), *range(1000)).moves) == 0
