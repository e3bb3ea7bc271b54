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
from vehicle_pf_tracker.image.shared_motion import shared_similarity, shared_stretch, staying


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
