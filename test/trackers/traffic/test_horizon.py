# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The row of the horizon, from how vehicles grow."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.horizon import Growth, Horizon

HEIGHT = 240


def grown(horizon, bottoms, factor=0.4):
    """Growth of a vehicle whose widths are zero at the row `horizon`, px."""
    growth = Growth()
    for bottom in bottoms:
        width = factor * (bottom - horizon) if horizon is not None else 40.0
        growth.add(np.array([100 - width / 2, bottom - 20, 100 + width / 2, bottom]))
    return growth


def test_one_vehicle_that_is_followed_tells_the_horizon():
    growth = grown(24, range(60, 160))
    assert Horizon().row(-0.2, [growth], HEIGHT) == pytest.approx(0.1, abs=0.04)


def test_the_more_vehicles_the_nearer():
    for factors in (1, 8):
        horizon = Horizon()
        for factor in range(factors):
            horizon.learn(grown(48, range(80, 200), 0.3 + 0.1 * factor), HEIGHT)
        row = horizon.row(-0.2, [], HEIGHT)
    assert row == pytest.approx(0.2, abs=0.02)


def test_widths_of_different_vehicles_are_not_compared():
    # Lorries drive in the nearer lane: from the side a wall of perspective, where there is none.
    lanes = [grown(None, 60 + np.sin(np.arange(60))), grown(None, 140 + np.sin(np.arange(60)), 3)]
    assert Horizon().row(-0.2, lanes, HEIGHT) <= -0.2


def test_what_did_not_move_tells_nothing():
    assert grown(24, [100.0] * 50).told(HEIGHT) is None
    assert grown(24, range(60, 70)).told(HEIGHT) is None
    assert Horizon().row(-50.0, [grown(24, [100.0] * 50)], HEIGHT) == -50.0


def test_vehicles_that_do_not_grow_put_it_far_above():
    assert Horizon().row(-0.2, [grown(None, range(60, 160))] * 3, HEIGHT) < -1


def test_one_that_is_wrong_does_not_move_it():
    right = [grown(24, range(60, 160), factor) for factor in (0.3, 0.4, 0.5)]
    wrong = Growth()
    for bottom in range(60, 160):
        wrong.add(np.array([0.0, bottom - 20, 300.0 - bottom, bottom]))
    assert Horizon().row(-0.2, [*right, wrong], HEIGHT) == pytest.approx(0.1, abs=0.03)
