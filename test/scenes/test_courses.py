# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Paths, speeds, and headings, by hand numbers."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.courses import Pace, Pose, moving, straight, swaying, wave
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION
from vehicle_pf_tracker.scenes.turning_vehicle import TurningVehicle
from vehicle_pf_tracker.scenes.vehicles import car

BOX = Box(10, 20, 4, 3)
START = Pose(100.0, 200.0, 0.0, 10.0)
SLANT = math.sin(VIEW_ELEVATION)


def test_distance_is_the_area_under_the_speed():
    pace = Pace(((0, 4), (10, 4), (20, 2)))
    assert [pace(frame) for frame in (5, 10, 15, 20, 30)] == pytest.approx([20, 40, 57.5, 70, 90])
    assert Pace(((8, 3),))(6) == pytest.approx(-6)


@given(st.lists(st.floats(0.5, 9), min_size=1, max_size=5), st.floats(0, 300))
def test_arrival_is_when_the_distance_is_covered(speeds, distance):
    pace = Pace(tuple((10.0 * number, speed) for number, speed in enumerate(speeds)))
    assert pace(pace.arrival(distance)) == pytest.approx(distance, abs=1e-6)


def test_swaying_adds_its_swings():
    pose = swaying(straight(START, Pace.steady(1.0)), wave(2, 40, 0), wave(0.5, 20, math.pi / 2))(
        10
    )
    assert (pose.x, pose.y) == pytest.approx((112, 199.5))
    box = swaying(moving(BOX, 1), wave(2, 40, 0), wave(0.5, 20, math.pi / 2))(10)
    assert (box.x, box.y, box.width) == pytest.approx((22, 19.5, 4))


@pytest.mark.parametrize("degrees", [0, 37, 90, 180, 270])
def test_the_box_of_a_model_is_tight_at_any_heading(degrees):
    model = TurningVehicle(car((100.0, 100.0, 100.0)), 10.0)
    body = model.on(lambda _: Pose(50.3, 60.7, math.radians(degrees), 10.0))[1]
    box = body.path(0)
    sprite = body.seen(0)
    # A car of 3.74 m by 1.68 m (lamps included) round its middle.
    across = 37.4 * abs(math.cos(math.radians(degrees)))
    across += 16.8 * abs(math.sin(math.radians(degrees)))
    assert box.width == pytest.approx(across, abs=1.2)
    assert box.x + box.width / 2 == pytest.approx(50.3, abs=0.8)
    assert 0.55 < sprite.area(box) / box.area <= 1
