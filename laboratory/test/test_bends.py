# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bends, by hand numbers."""

import math

import pytest

from laboratory.scenes.turns import Bend
from vehicle_pf_tracker.scenes.courses import Pace, Pose
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION

START = Pose(100.0, 200.0, 0.0, 10.0)
SLANT = math.sin(VIEW_ELEVATION)


def test_a_left_turn_goes_round_a_flattened_circle_and_away():
    bend = Bend(START, Pace.steady(1.0), straight=50, radius=40, angle=math.pi / 2)
    quarter = 40 * math.pi / 2
    assert bend(20) == Pose(120, 200, 0, 10)
    middle = bend(50 + quarter / 2)
    assert middle.heading == pytest.approx(math.pi / 4)
    assert middle.x == pytest.approx(150 + 40 * math.sin(math.pi / 4))
    assert middle.y == pytest.approx(200 - SLANT * 40 * (1 - math.cos(math.pi / 4)))
    end = bend(50 + quarter + 30)
    assert (end.x, end.y) == pytest.approx((190, 200 - SLANT * 70))
    assert end.heading == pytest.approx(math.pi / 2)


def test_a_right_turn_of_one_who_drives_left_goes_away_too():
    start = Pose(100.0, 200.0, math.pi, 10.0)
    end = Bend(start, Pace.steady(1.0), 50, 40, -math.pi / 2)(50 + 20 * math.pi + 30)
    assert (end.x, end.y) == pytest.approx((10, 200 - SLANT * 70))
