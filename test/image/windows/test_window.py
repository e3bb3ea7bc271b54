# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.image.windows.window import (
    Window,
    bounds,
    bounds_of_one,
    centres,
    is_outside,
    keep_inside,
)

FRAME = np.zeros((48, 64, 3), np.uint8)


@pytest.mark.parametrize(
    ("size", "half"),
    [((41, 31), (20, 15)), ((40, 30), (20, 14)), ((1, 1), (0, 0)), ((3, 2), (1, 0))],
)
def test_window_of_a_box_has_odd_sides(size, half):
    # Half of 40 is 19.5, which rounds to 20; half of 30 is 14.5, which rounds to 14.
    window = Window.of_size(*size)
    assert (window.half_width, window.half_height) == half
    assert (window.width, window.height) == (2 * half[0] + 1, 2 * half[1] + 1)


def test_the_pixel_of_a_position_is_half_rounded_to_even():
    assert centres(np.array([[30.5, 0.5], [30.0, 31.0], [1.49, 1.51]])).tolist() == [
        [30, 0],
        [30, 30],
        [1, 1],
    ]


def test_windows_over_the_border_keep_the_pixels_that_exist():
    at_corner = bounds(FRAME, np.array([[0.5, 0.5]]), Window(3, 2))
    assert [int(side[0]) for side in at_corner] == [0, 0, 4, 3]
    beyond = bounds(FRAME, np.array([[500.0, -500.0]]), Window(3, 2))
    assert [int(side[0]) for side in beyond] == [60, 0, 64, 3]


@given(
    x=st.floats(-1e6, 1e6),
    y=st.floats(-1e6, 1e6),
    half_width=st.integers(0, 100),
    half_height=st.integers(0, 100),
)
def test_every_window_has_a_pixel_and_stays_in_the_image(x, y, half_width, half_height):
    left, top, right, bottom = bounds(FRAME, np.array([[x, y]]), Window(half_width, half_height))
    assert 0 <= left[0] < right[0] <= 64
    assert 0 <= top[0] < bottom[0] <= 48


@given(x=st.floats(-1e6, 1e6), y=st.floats(-1e6, 1e6))
def test_positions_kept_inside_lie_on_a_pixel(x, y):
    inside = keep_inside(FRAME, np.array([[x, y]]))
    pixel = centres(inside)[0]
    assert 0 <= pixel[0] < 64
    assert 0 <= pixel[1] < 48
    assert not is_outside(FRAME, *inside[0])


@given(x=st.floats(), y=st.floats())
def test_one_position_is_kept_inside_like_a_row_of_several(x, y):
    """In scalars and in arrays: the same bits, also where a number is infinite or none."""
    alone = keep_inside(FRAME, np.array([x, y]))
    assert np.array_equal(alone, keep_inside(FRAME, np.array([[x, y]]))[0], equal_nan=True)


def test_outside_is_beyond_the_border():
    positions = (0.0, 0.0), (64.0, 48.0), (-0.1, 5.0), (5.0, 48.1)
    outside = [is_outside(FRAME, *position) for position in positions]
    assert outside == [False, False, True, True]


@given(
    st.floats(-1e6, 1e6) | st.integers(-20, 40).map(lambda half: half / 2),
    st.floats(-1e6, 1e6) | st.integers(-20, 40).map(lambda half: half / 2),
    st.integers(0, 9),
    st.integers(0, 9),
)
def test_one_window_is_where_many_are(x, y, half_width, half_height):
    frame, window = np.zeros((7, 11, 3), np.uint8), Window(half_width, half_height)
    many = bounds(frame, np.array([[x, y]]), window)
    assert bounds_of_one(frame, (x, y), window) == tuple(int(side[0]) for side in many)
