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

"""Shared motion of points: worked out by hand, among strays, and the same by both kernels."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.kernels.choice import load_kernels
from vehicle_pf_tracker.image.shared_motion import (
    CELL,
    carried_share,
    shared_similarity,
    shared_stretch,
    staying,
)


@pytest.fixture(scope="module")
def numba():
    pytest.importorskip("numba", reason="numba is not installed")
    return load_kernels("numba")


def moved(seed, turn=((1.01, -0.02), (0.02, 1.01)), shift=(4.0, -2.0), strays=8, noise=0.2):
    """Points before and after, the first of which have gone elsewhere."""
    rng = np.random.default_rng(seed)
    before = rng.uniform(0, 300, (48, 2))
    after = before @ np.transpose(turn) + shift + rng.normal(size=before.shape) * noise
    after[:strays] += rng.uniform(5, 20, (strays, 2))
    return before, after


def test_a_similarity_is_found_among_strays():
    before, after = moved(0)
    found = shared_similarity(before, after)
    assert found[:, :2] == pytest.approx(np.array([[1.01, -0.02], [0.02, 1.01]]), abs=2e-3)
    assert found[:, 2] == pytest.approx([4.0, -2.0], abs=0.3)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("strays", [0, 8, 30, 46])
def test_compiled_kernels_find_the_same_similarity(numba, seed, strays):
    before, after = moved(seed, strays=strays)
    expected = shared_similarity(before, after)
    assert numba.shared_similarity(before, after) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("count", "shift"), [(5, 9.0), (40, 0.3), (0, 0.0)])
def test_few_points_or_rest_are_no_motion(numba, count, shift):
    before = moved(1)[0][:count]
    for fit in (shared_similarity, numba.shared_similarity):
        assert np.array_equal(fit(before, before + shift), np.eye(2, 3))


def places(seed, strays):
    rng = np.random.default_rng(seed)
    before = rng.uniform(-0.4, 0.4, (36, 2))
    after = before @ np.array([[0.98, 0.2], [-0.2, 0.98]]) + rng.normal(size=before.shape) * 0.01
    after[:strays] += 0.5
    return before, after, rng.uniform(size=36) < 0.8


def test_strays_do_not_stay_and_the_lost_are_not_found_again():
    before, after, alive = places(2, 6)
    stays = staying(before, after, alive, 0.2)
    assert not stays[:6].any()
    assert np.array_equal(stays[6:], alive[6:])


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("strays", [0, 6, 20, 36])
def test_compiled_kernels_keep_the_same_places(numba, seed, strays):
    before, after, alive = places(seed, strays)
    expected = staying(before, after, alive, 0.2)
    assert np.array_equal(numba.staying(before, after, alive, 0.2), expected)
    nothing = np.zeros(36, bool)
    assert not numba.staying(before, after, nothing, 0.2).any()


@pytest.mark.parametrize("count", [4, 12, 35, 36])
@pytest.mark.parametrize("growth", [0.02, -0.03, 0.2])
def test_compiled_kernels_find_the_same_stretch(numba, count, growth):
    before = places(3, 0)[0][:count]
    after = before * np.exp([growth, -growth]) + [0.3, 0.1]
    expected = shared_stretch(before, after, np.ones(2))
    found = numba.shared_stretch(before, after, np.ones(2))
    assert found == pytest.approx(expected, abs=1e-12)
    assert expected.any() == (count >= 12)


STILL_BOX = np.array([[0.1, 0.1], [-1.6, -1.6]])
"""Places of points in a box of 10 x 10 px around (16, 16)."""
FROM_LEFT = np.array([[1.0, 1.0], [-5.0, 0.0]])
"""Of points whose vehicle has driven 5 px to the right."""
STANDS = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
NOT_TOLD = np.empty((0, 2))


def flow_of(*columns):
    """Flow of 32 x 32 px along x, by parts of equal width from left to right."""
    flow = np.zeros((32, 32, 2), np.float32)
    for part, each in zip(np.split(flow, len(columns), axis=1), columns, strict=True):
        part[..., 0] = each
    return flow


def block(*numbers):
    return np.array(numbers, np.intp).reshape(2, 2)


ALL = block(0, 0, 8, 8)


@pytest.mark.parametrize(
    ("columns", "background", "share"),
    [
        ((-5,), STANDS, 1.0),
        ((0,), STANDS, 0.0),
        ((-5, 0), STANDS, 0.5),
        ((-5, -20), STANDS, 0.5),
        ((-5, -5, 0, 0), NOT_TOLD, 0.5),
        ((-3.5,), STANDS, 1.0),
        ((-3.5,), NOT_TOLD, 1.0),
        ((0,), NOT_TOLD, 0.0),
    ],
)
def test_share_that_the_vehicle_carries(numba, columns, background, share):
    """What comes from elsewhere does not count, nor what stands."""
    for kernel in (carried_share, numba.carried_share):
        found = kernel(flow_of(*columns), ALL, STILL_BOX, FROM_LEFT, background)
        assert found == pytest.approx(share)


def test_a_vehicle_that_grows_carries_all_of_its_surface(numba):
    """By a quarter, which takes the outermost points 3.5 px off; they would not count otherwise."""
    flow = flow_of(0)
    flow[..., 0] = -5 - 0.25 * (np.arange(32) + 0.5 - 16)
    for kernel in (carried_share, numba.carried_share):
        assert kernel(flow, ALL, STILL_BOX, FROM_LEFT, NOT_TOLD) == 1.0


@pytest.mark.parametrize("seed", range(12))
def test_compiled_kernels_find_the_same_share(numba, seed):
    rng = np.random.default_rng(seed)
    side = 4 * int(rng.integers(2, 12))
    flow = rng.normal(-2, 3, (side, side, 2)).astype(np.float32)
    last = side // CELL
    low = rng.integers(0, last, 2)
    cells = np.stack([low, [rng.integers(1, last - at + 1) for at in low]]).astype(np.intp)
    places = np.array([[0.1, 0.12], [-0.05 * side, -0.06 * side]])
    vehicle = np.array([[1.05, 0.97], [-2.0, 0.5]])
    background = np.vstack([rng.normal(0, 0.05, (2, 2)) + np.eye(2), rng.normal(0, 2, 2)])
    for told in (background, NOT_TOLD):
        expected = carried_share(flow, cells, places, vehicle, told)
        assert numba.carried_share(flow, cells, places, vehicle, told) == pytest.approx(expected)
