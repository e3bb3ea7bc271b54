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

"""Climbing on a map: by hand, at its border, and the same by both kernels."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation_filter import climbed
from vehicle_pf_tracker.image.kernels.choice import load_kernels

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


@pytest.mark.parametrize("reach", [0, 1, 3])
def test_compiled_kernels_climb_to_the_same_places(reach):
    pytest.importorskip("numba", reason="numba is not installed")
    rng = np.random.default_rng(reach)
    values, costs = rng.normal(size=(20, 20)), rng.uniform(size=(2 * reach + 1, 2 * reach + 1))
    values[:4] = 0.0  # of equal gains the first is taken
    places = rng.integers(0, 20, (60, 2))
    expected, found = (
        climbed(values, places, costs),
        load_kernels("numba").climbed(values, places, costs),
    )
    assert np.array_equal(found[0], expected[0])
    assert np.array_equal(found[1], expected[1])
