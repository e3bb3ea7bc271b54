# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sides up to which an image changes: a patterned square that moves, to the pixel."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.changing_sides import changing_sides
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

STRIPES = np.tile(np.array([60, 220], np.uint8), (20, 10))


def picture(left, zoom=1.0):
    image = np.full((60, 100), 120, np.uint8)
    image[20:40, left : left + 20] = STRIPES
    return SmallGrey(image, zoom)


@pytest.mark.parametrize("zoom", [1.0, 0.5])
def test_sides_are_where_it_is_and_was(zoom):
    box = np.array([35, 20]) / zoom, np.array([55, 40]) / zoom
    outline = np.array([10, 15]) / zoom, np.array([80, 45]) / zoom
    low, high = changing_sides(picture(35, zoom), picture(32, zoom), box, outline)
    assert low == pytest.approx(np.array([32, 20]) / zoom)
    assert high == pytest.approx(np.array([55, 40]) / zoom)


def test_they_lie_within_the_outline():
    box = np.array([35.0, 20.0]), np.array([55.0, 40.0])
    outline = np.array([33.5, 22.5]), np.array([50.5, 38.5])
    low, high = changing_sides(picture(35), picture(32), box, outline)
    assert low == pytest.approx(outline[0])
    assert high == pytest.approx(outline[1])


def test_what_changes_less_than_three_tenths_of_the_box_stands():
    """All of the box changes; beside it one column by 5 of 20 rows, the next by 7."""
    box = np.array([35.0, 20.0]), np.array([55.0, 40.0])
    outline = np.array([20.0, 20.0]), np.array([60.0, 40.0])
    now, before = picture(35), picture(36)
    # Stripes that have moved by one px differ everywhere in the box.
    now.image[20:25, 25] = 200
    assert changing_sides(now, before, box, outline)[0][0] == 35
    now.image[20:27, 25] = 200
    assert changing_sides(now, before, box, outline)[0][0] == 25


def test_where_nothing_changes_there_are_none():
    box = np.array([35.0, 20.0]), np.array([55.0, 40.0])
    assert changing_sides(picture(35), picture(35), box, box) is None
    outside = np.array([200.0, 20.0]), np.array([220.0, 40.0])
    assert changing_sides(picture(35), picture(32), outside, outside) is None
