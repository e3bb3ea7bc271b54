# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Sprites: exact places, exact scale, exact visibility, by hand numbers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import PixelWindow, Sprite, paint, visible_fraction

WHITE = Sprite.plain((255.0, 255.0, 255.0))
PLACES = st.floats(-30, 70, allow_nan=False)
SIZES = st.floats(0.5, 40, allow_nan=False)


def canvas(width=40, height=30):
    return np.zeros((height, width, 3), np.float32)


def test_a_whole_pixel_box_fills_its_pixels_and_no_other():
    picture = canvas()
    paint(picture, WHITE, Box(3, 4, 5, 6))
    expected = canvas()
    expected[4:10, 3:8] = 255
    np.testing.assert_allclose(picture, expected, atol=1e-3)


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


@pytest.mark.parametrize("corner", [(-60, 5), (5, -60), (41, 5), (5, 31)])
def test_painting_outside_the_image_changes_nothing(corner):
    picture = canvas()
    paint(picture, WHITE, Box(*corner, 20, 20))
    assert not picture.any()


@given(PLACES, PLACES, SIZES, SIZES)
def test_painted_light_is_the_area_inside_the_image(x, y, width, height):
    picture = canvas()
    paint(picture, WHITE, Box(x, y, width, height))
    across = max(0.0, min(x + width, 40) - max(x, 0))
    down = max(0.0, min(y + height, 30) - max(y, 0))
    assert picture[..., 0].sum() / 255 == pytest.approx(across * down, rel=1e-4, abs=1e-3)


@given(st.floats(2, 20), st.floats(2, 15))
def test_centre_of_mass_is_the_centre_of_the_box(x, y):
    picture = canvas()
    box = Box(x, y, 9.3, 7.1)
    paint(picture, WHITE, box)
    rows, columns = np.indices(picture.shape[:2]) + 0.5
    light = picture[..., 0].astype(np.float64)
    found = (light * columns).sum() / light.sum(), (light * rows).sum() / light.sum()
    # Light in a pixel counts at its middle, wherever in it the edge runs: at most 1/8 px / 7.1.
    assert found == pytest.approx(box.centre, abs=0.02)


@pytest.mark.parametrize(
    ("cover", "visible"),
    [
        (Box(0, 0, 3, 30), 0.7 + 0.2),
        (Box(5, 0, 3, 30), 0.7),
        (Box(2, 10, 10, 5), 0.5),
        (Box(4.5, 0, 3.25, 30), 0.675),
        (Box(0, 0, 40, 30), 0.0),
        (Box(20, 0, 3, 30), 1.0),
        (Box(12, 0, 3, 30), 1.0),
    ],
)
def test_visible_fraction_by_hand(cover, visible):
    target = WHITE, Box(2, 10, 10, 10)
    assert visible_fraction(target, [(WHITE, cover)], 40, 30) == pytest.approx(visible, abs=1e-9)


def test_two_covers_hide_what_either_hides():
    target = WHITE, Box(0, 0, 10, 10)
    covers = [(WHITE, Box(0, 0, 4, 10)), (WHITE, Box(2, 0, 4, 10))]
    assert visible_fraction(target, covers, 40, 30) == pytest.approx(0.4)


@pytest.mark.parametrize(("left", "visible"), [(-4, 0.6), (35, 0.5), (-10, 0.0), (40, 0.0)])
def test_parts_outside_the_image_are_not_visible(left, visible):
    target = WHITE, Box(left, 5, 10, 10)
    assert visible_fraction(target, [], 40, 30) == pytest.approx(visible, abs=1e-9)


def test_only_the_silhouette_counts():
    half = Sprite(np.zeros((1, 2, 3)), [[1, 0]])
    assert half.area(Box(0, 0, 10, 10)) == pytest.approx(50)
    over_empty_half = [(WHITE, Box(5, 0, 5, 10))]
    assert visible_fraction((half, Box(0, 0, 10, 10)), over_empty_half, 40, 30) == 1.0


@given(PLACES, PLACES, SIZES, SIZES)
def test_a_target_free_inside_the_image_is_wholly_visible(x, y, width, height):
    inside = min(x, y) >= 0 and x + width <= 40 and y + height <= 30
    seen = visible_fraction((WHITE, Box(x, y, width, height)), [], 40, 30)
    assert 0 <= seen <= 1
    assert not inside or seen == 1.0


def test_window_of_a_box_is_clipped_to_the_image():
    assert PixelWindow.of(Box(-2.5, 3.2, 5, 1.5), 40, 30) == PixelWindow(0, 3, 3, 5)
    assert PixelWindow.of(Box(50, 3, 5, 1), 40, 30).empty
