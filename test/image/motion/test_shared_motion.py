# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shared motion of points: worked out by hand, and among strays."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.box_motion import carried_share, shared_stretch, staying
from vehicle_pf_tracker.image.motion.shared_motion import median, shared_similarity


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


@pytest.mark.parametrize(("count", "shift"), [(5, 9.0), (40, 0.3), (0, 0.0)])
def test_few_points_or_rest_are_no_motion(count, shift):
    before = moved(1)[0][:count]
    assert np.array_equal(shared_similarity(before, before + shift), np.eye(2, 3))


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


def test_of_nothing_nothing_stays():
    before, after, _ = places(2, 6)
    assert not staying(before, after, np.zeros(36, bool), 0.2).any()


@pytest.mark.parametrize("count", [1, 2, 7, 100])
def test_the_median_is_numpys_to_the_bit(count):
    values = np.random.default_rng(count).normal(size=count)
    assert median(values) == float(np.median(values))


@pytest.mark.parametrize(
    ("count", "growth", "found"),
    [
        (36, 0.02, 0.02),
        (12, -0.03, -0.03),
        (36, 0.2, 0.15),
        (11, 0.02, 0),
        (1, 0.02, 0),
        (0, 0.02, 0),
    ],
)
def test_stretch_is_the_growth_within_its_bound_of_points_that_are_enough(count, growth, found):
    before = places(3, 0)[0][:count]
    after = before * np.exp([growth, -growth]) + [0.3, 0.1]
    assert shared_stretch(before, after, np.ones(2)) == pytest.approx([found, -found])


STILL_BOX = np.array([[0.1, 0.1], [-1.6, -1.6]])
"""Places of points in a box of 10 x 10 px around (16, 16)."""
FROM_LEFT = np.array([[1.0, 1.0], [-5.0, 0.0]])
"""Earlier places of points whose vehicle has driven 5 px to the right."""
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
def test_share_that_the_vehicle_carries(columns, background, share):
    """Points that come from elsewhere do not count, nor those that stand."""
    found = carried_share(flow_of(*columns), ALL, STILL_BOX, FROM_LEFT, background)
    assert found == pytest.approx(share)


def test_a_vehicle_that_grows_carries_all_of_its_surface():
    """It grows by a quarter: the outermost points are 3.5 px off, and would not count otherwise."""
    flow = flow_of(0)
    flow[..., 0] = -5 - 0.25 * (np.arange(32) + 0.5 - 16)
    assert carried_share(flow, ALL, STILL_BOX, FROM_LEFT, NOT_TOLD) == 1.0
