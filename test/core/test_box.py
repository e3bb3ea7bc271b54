# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError


def test_centre_is_the_corner_plus_half_the_size():
    assert Box(10, 20, 41, 30).centre == (30.5, 35.0)
    assert Box.around((30.5, 35.0), 41, 30) == Box(10, 20, 41, 30)


def test_diagonal_area_corners():
    box = Box(1, 2, 3, 4)
    assert box.diagonal == 5
    assert box.area == 12
    assert box.corners == ((1, 2), (4, 2), (4, 6), (1, 6))


@pytest.mark.parametrize(
    "box",
    [
        Box(math.nan, 0, 5, 5),
        Box(0, 0, math.inf, 5),
        Box(0, 0, 0, 5),
        Box(0, 0, 5, -1),
        Box(-1e30, -1e30, 2e30, 2e30),
        Box(-100, 0, 257, 5),
        Box(0, -80, 5, 193),
        Box(100, 0, 10, 10),
        Box(-20, 0, 10, 10),
        Box(0, 60, 10, 10),
    ],
)
def test_boxes_no_tracker_can_start_on(box):
    with pytest.raises(InputError, match="target"):
        check_target(box, 64, 48)


@pytest.mark.parametrize(
    "box", [Box(0, 0, 1, 1), Box(-5, -5, 10, 10), Box(59, 43, 10, 10), Box(-96, -72, 256, 192)]
)
def test_boxes_at_the_border_are_targets(box):
    assert check_target(box, 64, 48) is box


sides = st.floats(0.5, 200)
boxes = st.builds(Box, st.floats(-300, 300), st.floats(-300, 300), sides, sides)


def test_overlap_by_hand():
    square = Box(0, 0, 10, 10)
    assert square.iou(square) == 1
    assert square.iou(Box(5, 0, 10, 10)) == pytest.approx(50 / 150)
    assert square.iou(Box(5, 5, 10, 10)) == pytest.approx(25 / 175)
    assert square.iou(Box(2, 2, 5, 5)) == pytest.approx(0.25)
    assert square.iou(Box(10, 0, 10, 10)) == square.iou(Box(0, 30, 10, 10)) == 0


@given(boxes, boxes)
def test_overlap_is_symmetric_and_a_share(one, other):
    assert one.iou(other) == pytest.approx(other.iou(one), abs=1e-12)
    assert 0 <= one.iou(other) <= 1 + 1e-12
    assert one.iou(one) == pytest.approx(1)
