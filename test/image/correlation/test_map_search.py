# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Climbing on a map, by hand numbers; compiled, to the same bits."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation.map_search import climbed
from vehicle_pf_tracker.image.kernels.interface import load_kernels

NEAR = np.array([[0.2, 0.1, 0.2], [0.1, 0.0, 0.1], [0.2, 0.1, 0.2]])


@pytest.fixture(scope="module")
def compiled():
    pytest.importorskip("numba", reason="numba is not installed")
    return load_kernels("numba").climbed


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


@pytest.mark.parametrize("reach", [0, 1, 5])
@pytest.mark.parametrize("decimals", [0, 9], ids=["equal values", "no two alike"])
@pytest.mark.parametrize("spread", [2.0, 60.0], ids=["in the middle", "at the border too"])
def test_compiled_it_gives_the_same_bits(compiled, reach, decimals, spread):
    rng = np.random.default_rng(reach)
    values = rng.normal(size=(32, 40)).round(decimals)
    places = np.rint(rng.normal(16, spread, (200, 2))).clip(0, 31).astype(np.intp)
    offsets = np.arange(-reach, reach + 1) ** 2
    costs = 0.25 * (offsets[:, np.newaxis] + offsets)
    for ours, theirs in zip(
        compiled(values, places, costs), climbed(values, places, costs), strict=True
    ):
        assert ours.dtype == theirs.dtype
        assert ours.tobytes() == theirs.tobytes()


@pytest.mark.parametrize(
    ("places", "costs"),
    [
        ([[4, 0]], NEAR),
        ([[0, -1]], NEAR),
        ([[0, 0]], NEAR[:2]),
        ([[0, 0]], NEAR[:2, :2]),
        ([[0, 0, 0]], NEAR),
    ],
)
def test_compiled_it_refuses_what_does_not_fit(compiled, places, costs):
    with pytest.raises(IndexError):
        compiled(np.zeros((4, 4)), np.array(places), np.ascontiguousarray(costs))
