# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sprites at exact positions and scales, exact visibility, and filled polygons, by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import PixelWindow, Sprite
from vehicle_pf_tracker.scenes.courses import standing
from vehicle_pf_tracker.scenes.polygons import cells_inside
from vehicle_pf_tracker.scenes.scene import Actor

WHITE = Sprite.plain((255.0, 255.0, 255.0))
PLACES = st.floats(-30, 70, allow_nan=False)
SIZES = st.floats(0.5, 40, allow_nan=False)


def canvas(width=40, height=30):
    return np.zeros((height, width, 3), np.float32)


def paint(picture, sprite, box):
    Actor(sprite, standing(box)).paint(picture, 0)


def test_a_quarter_pixel_shift_splits_the_edge_pixels():
    picture = canvas()
    paint(picture, WHITE, Box(3.25, 4, 2, 1))
    np.testing.assert_allclose(picture[4, 3:6, 0], (0.75 * 255, 255, 0.25 * 255), atol=1e-3)


def test_a_sprite_is_averaged_when_it_shrinks_and_repeated_when_it_grows():
    colour = np.array([[[10, 0, 0], [30, 0, 0]]])
    sprite = Sprite(colour, np.ones((1, 2)))
    small, big = canvas(), canvas()
    paint(small, sprite, Box(0, 0, 1, 1))
    paint(big, sprite, Box(0, 0, 4, 1))
    assert small[0, 0, 0] == pytest.approx(20)
    np.testing.assert_allclose(big[0, :5, 0], (10, 10, 30, 30, 0), atol=1e-4)


def test_half_opacity_mixes_with_what_is_behind():
    picture = canvas() + np.float32(100)
    paint(picture, Sprite.plain((200.0, 0.0, 100.0), 0.5), Box(0, 0, 2, 2))
    np.testing.assert_allclose(picture[0, 0], (150, 50, 100))
    np.testing.assert_allclose(picture[0, 2], 100)


@given(PLACES, PLACES, SIZES, SIZES)
def test_painted_light_is_the_area_inside_the_image(x, y, width, height):
    picture = canvas()
    paint(picture, WHITE, Box(x, y, width, height))
    across = max(0.0, min(x + width, 40) - max(x, 0))
    down = max(0.0, min(y + height, 30) - max(y, 0))
    assert picture[..., 0].sum() / 255 == pytest.approx(across * down, rel=1e-4, abs=1e-3)


def filled(corners, rows=8, columns=10):
    grid = np.zeros((rows, columns), bool)
    window, inside = cells_inside(np.array(corners, float), rows, columns)
    grid[window.slices] = inside
    return grid


@pytest.mark.parametrize("turn", [1, -1])
def test_a_rectangle_on_cell_edges_fills_its_cells(turn):
    grid = filled([(2, 1), (6, 1), (6, 4), (2, 4)][::turn])
    assert grid[1:4, 2:6].all()
    assert grid.sum() == 12


def test_a_cell_belongs_to_the_polygon_that_has_its_centre():
    assert filled([(2.6, 1), (6.4, 1), (6.4, 2), (2.6, 2)])[1].nonzero()[0].tolist() == [3, 4, 5]


def test_two_polygons_that_share_an_edge_share_no_cell_and_leave_no_gap():
    upper, lower = filled([(0, 0), (8, 0), (8, 8)]), filled([(0, 0), (8, 8), (0, 8)])
    assert not (upper & lower).any()
    assert (upper | lower)[:, :8].all()


def test_a_notch_stays_empty():
    grid = filled([(0, 0), (9, 0), (9, 6), (6, 6), (6, 2), (3, 2), (3, 6), (0, 6)])
    assert grid.sum() == 9 * 6 - 3 * 4
    assert not grid[2:6, 3:6].any()


def test_what_lies_outside_the_grid_is_clipped():
    assert filled([(-5, -5), (50, -5), (50, 50), (-5, 50)]).all()
    window, inside = cells_inside(np.array([(2.2, 3.1), (4.2, 3.1), (4.2, 3.3)]), 8, 10)
    assert window == PixelWindow(2, 3, 5, 4)
    assert not inside.any()
