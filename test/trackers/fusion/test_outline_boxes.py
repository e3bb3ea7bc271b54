# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bounding boxes of outlines, by hand."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.outline_boxes import areas, front_move


def box(left, top, right, bottom):
    return np.array([[left, top], [right, bottom]], float)


def test_areas_are_width_times_height():
    assert areas(np.stack([box(0, 0, 3, 2), box(5, 5, 6, 9)])).tolist() == [6, 4]
    assert areas(np.empty((0, 2, 2))).tolist() == []


@pytest.mark.parametrize(
    ("last", "move"),
    [
        (box(10, 10, 34, 18), [4, -2]),  # comes out to the right, and the road goes up
        (box(5, 10, 30, 20), [-5, 0]),  # comes out to the left
        (box(17, 10, 37, 20), [7, 0]),  # all of it drives
    ],
)
def test_the_side_that_moves_further_is_in_front(last, move):
    assert front_move(box(10, 10, 30, 20), last).tolist() == move
