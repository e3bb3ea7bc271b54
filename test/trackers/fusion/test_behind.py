# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What is behind a hidden vehicle is another one, by how far it should have come."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.behind import is_behind
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting

LAST = Sighting(0.0, np.array([100.0, 60.0]), np.array([20.0, 12.0]))
"""The size, the root of 20 x 12, is 15.5 px."""
MOTION = PerspectiveMotion(LAST.position, np.array([2.0, 0.0]), 0.0)
"""Motion to the right."""


def test_behind_the_last_sighting_by_half_a_size_is_another_vehicle():
    positions = LAST.position + np.array([[-8.0, 0.0], [-7.0, 20.0], [60.0, 0.0]])
    assert is_behind(positions, MOTION, LAST, 0.0).tolist() == [True, False, False]


@pytest.mark.parametrize(("age", "bound"), [(4.0, -0.5 * 15.5 + 0.75 * 8), (8.0, 3.9), (90.0, 3.9)])
def test_what_should_have_moved_by_its_size_is_not_where_it_was(age, bound):
    """By less than a size in 4 frames; after 8, one that brakes may fall behind for long."""
    positions = LAST.position + np.array([[bound - 0.1, 5.0], [bound + 0.1, -5.0]])
    assert is_behind(positions, MOTION, LAST, age).tolist() == [True, False]


def test_of_a_vehicle_that_stood_nothing_is_behind():
    standing = PerspectiveMotion(LAST.position, np.zeros(2), 0.0)
    assert not is_behind(LAST.position - np.array([[30.0, 0.0]]), standing, LAST, 30.0).any()
