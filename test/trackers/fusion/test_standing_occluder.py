# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sightings that a standing occluder has cut: made whole where one side stands, else left."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.perspective import Sightings
from vehicle_pf_tracker.trackers.fusion.standing_occluder import restored_sightings

COUNT = 30
AGES = np.arange(COUNT)[::-1].astype(float)
CLEAR = np.ones(COUNT)


def sides(speed, wall=None, *, axis=0, growth=0.0):
    """Boxes of a vehicle of 40 x 20 px that drives along an axis, cut at a wall's edge."""
    times = np.arange(COUNT)
    sizes = np.outer(np.exp(growth * times), [40.0, 20.0])
    centres = np.full((COUNT, 2), 100.0)
    centres[:, axis] += speed * times
    low, high = centres - sizes / 2, centres + sizes / 2
    whole = centres.copy(), sizes.copy()
    if wall is not None and speed > 0:
        high[:, axis] = np.minimum(high[:, axis], wall)
    elif wall is not None:
        low[:, axis] = np.maximum(low[:, axis], wall)
    return ((low + high) / 2, high - low), whole


@pytest.mark.parametrize(
    ("speed", "wall", "axis"), [(2.0, 150.0, 0), (-2.0, 50.0, 0), (1.0, 120.0, 1)]
)
def test_the_side_behind_a_wall_is_restored(speed, wall, axis):
    seen, whole = sides(speed, wall, axis=axis)
    assert seen[1][-1, axis] < 0.75 * whole[1][-1, axis]
    positions, sizes = restored_sightings(AGES, *seen, CLEAR)
    assert positions == pytest.approx(whole[0])
    assert sizes == pytest.approx(whole[1])


def test_a_vehicle_that_grows_is_restored_to_its_present_size():
    seen, whole = sides(2.0, 155.0, growth=0.01)
    positions, sizes = restored_sightings(AGES, *seen, CLEAR)
    assert sizes[-1] == pytest.approx(whole[1][-1], rel=0.02)
    assert positions[-1] == pytest.approx(whole[0][-1], abs=1.0)


def test_what_is_seen_is_not_changed():
    seen, _ = sides(2.0, 150.0)
    before = [each.copy() for each in seen]
    restored_sightings(AGES, *seen, CLEAR)
    assert all(np.array_equal(*pair) for pair in zip(before, seen, strict=True))


def test_a_vehicle_that_turns_is_left_as_it_is():
    """Its box becomes narrower, but both sides of it drive on."""
    (positions, sizes), _ = sides(3.0)
    sizes[:, 0] *= np.exp(-0.02 * np.arange(COUNT))
    assert restored_sightings(AGES, positions, sizes, CLEAR) is None


@pytest.mark.parametrize(
    ("ages", "speed", "options"),
    [
        (AGES, 2.0, {}), (AGES, 0.0, {}), (AGES, 0.2, {"growth": 0.03}),
        (0 * AGES, 2.0, {"wall": 150.0}),
    ],
    ids=["drives in the open", "stands", "comes closer", "all of one moment"],
)  # fmt: skip
def test_what_no_wall_is_seen_to_cut_is_left_as_it_is(ages, speed, options):
    assert restored_sightings(ages, *sides(speed, **options)[0], CLEAR) is None


@pytest.mark.parametrize(("kept", "response"), [(12, 1.0), (COUNT, 0.5)])
def test_few_or_unclear_sightings_are_left_as_they_are(kept, response):
    (positions, sizes), _ = sides(2.0, 150.0)
    found = restored_sightings(
        AGES[-kept:], positions[-kept:], sizes[-kept:], response * CLEAR[-kept:]
    )
    assert found is None


def test_the_prediction_begins_with_the_whole_vehicle():
    (positions, sizes), whole = sides(2.0, 150.0)
    sightings = Sightings()
    for position, size in zip(positions, sizes, strict=True):
        sightings = sightings.moved_on(1.0, CameraMotion())
        sightings = sightings.added(position, size, 1.0)
    motion, last = sightings.fit()
    assert last.cut
    assert last.size == pytest.approx(whole[1][-1])
    assert motion.velocity == pytest.approx([2.0, 0.0], abs=0.05)
    assert motion.position == pytest.approx(whole[0][-1], abs=0.5)
