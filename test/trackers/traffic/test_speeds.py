# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Speeds that new vehicles may have."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.speeds import Speeds
from vehicle_pf_tracker.trackers.traffic.vehicle_state import ANY_SPEED

NOBODY = np.empty((0, 2))


def spread(speeds, followed=NOBODY, assumed=5.0, period=0.4):
    """Covariance in squares of widths per interval."""
    return speeds.spread(followed, assumed, period) * assumed**2


def test_in_dense_images_a_new_vehicle_may_have_any_speed():
    speeds = Speeds()
    speeds.learn(np.full((40, 2), 0.1))
    assert (speeds.spread(NOBODY, 0.5, 1 / 30) == ANY_SPEED).all()


def test_new_vehicles_drive_as_those_before_both_ways():
    speeds = Speeds()
    # Two widths per second along the road, as many of either direction: .8 widths in an interval.
    speeds.learn(np.array([[0.0, 2.0], [0.0, -2.0]] * 12))
    across, along = spread(speeds).diagonal()
    assert across == pytest.approx(1 + 0.25 * 25 / 24.25)
    assert along == pytest.approx(1 + (0.25 * 25 + 24 * 0.8**2) / 24.25)
    assert spread(Speeds())[0, 0] == pytest.approx(26)


def test_vehicles_that_are_followed_count_as_those_that_left():
    followed = np.array([[0.4, 0.8]] * 3)
    left = Speeds()
    left.learn(followed / 0.4)
    assert spread(Speeds(), followed) == pytest.approx(spread(left))


def test_a_road_that_changes_is_learnt_anew():
    speeds = Speeds()
    speeds.learn(np.full((50, 2), 1.0))
    for _ in range(200):
        speeds.learn(np.full((1, 2), 10.0))
    assert spread(speeds)[0, 0] > 15
