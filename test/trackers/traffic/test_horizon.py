# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The row of the horizon: that of a calibrated road, else from how vehicles grow."""

import numpy as np
import pytest
from seen_roads import SIZE, road

from vehicle_pf_tracker.trackers.traffic.horizon import (
    Growths,
    Horizon,
    calibrated_row,
    explaining_row,
)

HEIGHT = 240
ALL = np.array([True])


def grown(horizon, bottoms, factor=0.4):
    """Growth of a vehicle whose widths are zero at the row `horizon`, px."""
    growth = Growths.unknown(1)
    for bottom in bottoms:
        width = factor * (bottom - horizon) if horizon is not None else 40.0
        box = [100 - width / 2, bottom - 20, 100 + width / 2, bottom]
        growth = growth.added(np.array([box]), ALL)
    return growth


def row(assumed, *growths):
    regressions = [growth.regressions(HEIGHT) for growth in growths]
    return explaining_row(assumed, np.concatenate([np.empty((0, 3)), *regressions]))


def test_one_vehicle_that_is_followed_tells_the_horizon():
    growth = grown(24, range(60, 160))
    assert row(-0.2, growth) == pytest.approx(0.1, abs=0.04)


def test_the_more_vehicles_the_nearer():
    for factors in (1, 8):
        horizon = Horizon()
        for factor in range(factors):
            grows = grown(48, range(80, 200), 0.3 + 0.1 * factor)
            horizon = horizon.learnt(grows, HEIGHT)
        horizon = horizon.updated(-0.2, Growths.unknown(0), (320, HEIGHT), None)
    assert horizon.row / HEIGHT == pytest.approx(0.2, abs=0.02)


def test_widths_of_different_vehicles_are_not_compared():
    # Lorries drive in the nearer lane: from the side a wall of perspective, where there is none.
    lanes = [grown(None, 60 + np.sin(np.arange(60))), grown(None, 140 + np.sin(np.arange(60)), 3)]
    assert row(-0.2, *lanes) <= -0.2


def test_what_did_not_move_tells_nothing():
    assert len(grown(24, [100.0] * 50).regressions(HEIGHT)) == 0
    assert len(grown(24, range(60, 70)).regressions(HEIGHT)) == 0
    assert row(-50.0, grown(24, [100.0] * 50)) == -50.0


def test_vehicles_that_do_not_grow_put_it_far_above():
    assert row(-0.2, *[grown(None, range(60, 160))] * 3) < -1


def test_one_that_is_wrong_does_not_move_it():
    right = [grown(24, range(60, 160), factor) for factor in (0.3, 0.4, 0.5)]
    wrong = Growths.unknown(1)
    for bottom in range(60, 160):
        wrong = wrong.added(np.array([[0.0, bottom - 20, 300.0 - bottom, bottom]]), ALL)
    assert row(-0.2, *right, wrong) == pytest.approx(0.1, abs=0.03)


def test_of_sparse_images_fewer_boxes_tell():
    growth = grown(24, range(60, 160, 12))
    assert len(growth.regressions(HEIGHT)) == 0
    assert len(growth.regressions(HEIGHT, sparsity=8.0)) == 1


def test_the_calibrated_horizon_is_where_the_camera_sees_it():
    row = calibrated_row(road(), SIZE)
    assert row * SIZE[1] == pytest.approx(240 - 800 * 8 / 60, abs=1e-6)
    far = road().to_image(np.array([0.0, 1e7]))
    assert row * SIZE[1] == pytest.approx(far[1], abs=0.01)


def test_the_horizon_of_a_camera_that_looks_down_is_far_above():
    assert calibrated_row(road(ahead=0.5), SIZE) == pytest.approx(-1 / 0.3)
