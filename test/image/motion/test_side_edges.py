# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edges of drawn masks: a rectangle of 30 x 20 px, whose mask reaches half a pixel too far."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.side_edges import edges_beyond, outermost_beyond

LOW, HIGH = np.array([25.0, 20.0]), np.array([55.0, 40.0])
SIZE = HIGH - LOW


def rectangle():
    mask = np.zeros((60, 80), np.uint8)
    mask[20:40, 25:55] = 1
    return mask


def test_the_edges_of_a_rectangle_are_half_a_pixel_inside_its_mask():
    found = edges_beyond(rectangle(), LOW, HIGH)
    assert found == pytest.approx(np.array([-0.5, -0.5]) / np.array([SIZE, SIZE]))


@pytest.mark.parametrize("shift", [-3.0, 4.5])
def test_each_side_is_found_from_either_side_of_its_edge(shift):
    """The box's left side is moved, then its lower one; outwards is positive."""
    left = edges_beyond(rectangle(), LOW + np.array([shift, 0]), HIGH)
    assert left[0, 0] == pytest.approx((shift - 0.5) / (30 - shift))
    lower = edges_beyond(rectangle(), LOW, HIGH + np.array([0, shift]))
    assert lower[1, 1] == pytest.approx((-shift - 0.5) / (20 + shift))
    assert lower[1, 0] == pytest.approx(-0.5 / 30)


def test_a_neighbour_at_a_corner_hides_no_edge():
    mask = rectangle()
    mask[38:60, 50:80] = 1
    found = edges_beyond(mask, LOW, HIGH)
    assert found == pytest.approx(np.array([-0.5, -0.5]) / np.array([SIZE, SIZE]))


def test_a_side_with_a_neighbour_or_a_slanted_rim_has_no_edge():
    mask = rectangle()
    mask[20:40, 55:80] = 1
    # A third of the rows go on for a third of the width.
    mask[24:28, 15:25] = 1
    found = edges_beyond(mask, LOW, HIGH)
    assert np.isnan(found).tolist() == [[True, False], [True, False]]


@pytest.mark.parametrize(("slant", "is_edge"), [(4, True), (14, False)])
def test_a_vehicle_that_stands_aslant_in_its_box_has_no_edge_at_its_middle(slant, is_edge):
    """Its left rim goes `slant` px to the right from the lowest row to the highest.

    Half of the 12 rows that are looked at lie within 1.3 and 4.4 px of that; an edge of a box of
    30 px is at most 4 px wide.
    """
    mask = rectangle()
    for row in range(20):
        mask[39 - row, 25 : 25 + round(slant * row / 19)] = 0
    assert np.isnan(edges_beyond(mask, LOW, HIGH)[0, 0]) != is_edge


def test_what_is_farther_than_a_third_of_the_size_is_another():
    mask = rectangle()
    mask[20:40, 55:67] = 1
    assert np.isnan(edges_beyond(mask, LOW, HIGH)[1, 0])
    mask[:, 65:] = 0
    assert edges_beyond(mask, LOW, HIGH)[1, 0] == pytest.approx(9.5 / 30)


def test_a_vehicle_that_the_background_shows_has_no_edges():
    mask = rectangle()
    mask[24:36, 30:46] = 0
    assert edges_beyond(mask, LOW, HIGH) is None
    assert edges_beyond(rectangle(), LOW + 100, HIGH + 100) is None
    assert edges_beyond(rectangle(), LOW - 100, HIGH - 100) is None


def test_a_box_of_a_few_pixels_has_no_edges():
    """They are good to a pixel, here of 8 and of 7."""
    assert edges_beyond(rectangle(), LOW + 10, LOW + 18) is not None
    assert edges_beyond(rectangle(), LOW + 10, LOW + 17) is None


def test_a_plain_vehicle_moves_at_its_rims_only():
    """Its first and last three columns and rows do; what is inside of them does, too."""
    mask = rectangle()
    mask[23:37, 28:52] = 0
    assert edges_beyond(mask, LOW, HIGH) is None
    found = outermost_beyond((mask, mask), (mask, mask), LOW, HIGH)
    assert found == pytest.approx(np.array([[-0.5, -0.5]] * 2) / np.array([30, 20]))


def test_each_side_is_found_in_its_own_mask():
    empty = np.zeros_like(rectangle())
    found = outermost_beyond((rectangle(), empty), (empty, rectangle()), LOW, HIGH)
    assert np.isfinite(found).tolist() == [[True, False], [False, True]]


def test_the_outermost_edge_counts_if_it_is_near_enough():
    """From 7 to 9 px beside the rectangle, and 12 px beside it, of 30 px."""
    mask = rectangle()
    mask[20:40, 62:64] = 1
    assert edges_beyond(mask, LOW, HIGH)[1, 0] == pytest.approx(-0.5 / 30)
    found = outermost_beyond((mask, mask), (mask, mask), LOW, HIGH)
    assert found[1, 0] == pytest.approx(8.5 / 30)
    mask[20:40, 67:69] = 1
    assert np.isnan(outermost_beyond((mask, mask), (mask, mask), LOW, HIGH)[1, 0])
