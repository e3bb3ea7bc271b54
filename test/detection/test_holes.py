# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Holes in the background of what has left, told from vehicles by their outlines."""

import numpy as np
import pytest

from vehicle_pf_tracker.detection.holes import is_hole

PART = np.zeros((30, 40), np.uint8)
PART[8:22, 10:30] = 1
ROAD = np.full((30, 40), 300, np.float32)


def with_vehicle(level, ground=ROAD):
    return np.where(PART > 0, np.float32(level), ground)


@pytest.mark.parametrize("level", [100, 250, 600])
def test_where_the_background_has_a_vehicle_the_image_has_left_it_is_a_hole(level):
    assert is_hole(ROAD, with_vehicle(level), PART)
    assert not is_hole(with_vehicle(level), ROAD, PART)


def test_edges_of_a_fence_behind_a_vehicle_make_no_hole():
    fence = np.tile(np.float32([200, 200, 420, 420]), (30, 10))
    assert not is_hole(with_vehicle(600, fence), fence, PART)
    assert is_hole(fence, with_vehicle(600, fence), PART)


def test_without_edges_nothing_is_a_hole():
    assert not is_hole(ROAD, ROAD + 50, PART)
