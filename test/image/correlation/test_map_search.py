# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Climbing on a map, by hand numbers."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation.map_search import climbed

NEAR = np.array([[0.2, 0.1, 0.2], [0.1, 0.0, 0.1], [0.2, 0.1, 0.2]])


def test_a_move_has_to_be_worth_its_cost():
    values = np.zeros((8, 8))
    values[3, 5], values[6, 2] = 1.0, 0.15
    moves, gains = climbed(values, np.array([[4, 2], [3, 5], [1, 1]]), NEAR)
    assert np.array_equal(moves, [[1, 1], [0, 0], [0, 0]])
    assert gains == pytest.approx([0.8, 0.0, 0.0])


def test_beyond_the_border_the_outermost_values_are_repeated():
    values = np.zeros((4, 4))
    values[0, 3] = 1.0
    moves, gains = climbed(values, np.array([[2, 0], [3, 0]]), -NEAR)
    assert np.array_equal(moves, [[1, -1], [1, -1]])
    assert gains == pytest.approx([1.2, 1.2])
