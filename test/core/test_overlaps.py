# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Areas and overlaps of boxes, with hand numbers."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import are_alone, areas, clipped, inside_image, overlaps

BOX = np.array([10.0, 10, 50, 40])
OTHERS = np.array([[30.0, 10, 70, 40], [60, 60, 70, 70]])


def test_areas_and_overlaps_are_those_of_rectangles():
    assert intersections(BOX, OTHERS).tolist() == [600, 0]
    assert overlaps(BOX, OTHERS) == pytest.approx([600 / 1800, 0])
    assert areas(BOX) == 1200


def test_a_box_without_an_area_has_one_so_that_shares_of_it_are_finite():
    assert areas(np.array([[5.0, 5, 5, 5], [5, 5, 4, 9]])).tolist() == [1, 1]


def test_who_overlaps_none_of_the_others_is_alone():
    assert are_alone(np.vstack([BOX, OTHERS])).tolist() == [False, False, True]


def test_boxes_are_cut_at_the_image_and_keep_a_pixel():
    assert inside_image(BOX, (30, 240)) == 0.5
    assert clipped(np.array([[-5.0, 5, 20, 300]]), (100, 240)).tolist() == [[0, 5, 20, 240]]
    assert clipped(np.array([[200.0, 5, 220, 30]]), (100, 240)).tolist() == [[99, 5, 100, 30]]
