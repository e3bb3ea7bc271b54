# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A side that unfolds: a textured rectangle whose box stays on its right end."""

import numpy as np
import pytest
from fusion_samples import grey_road

from vehicle_pf_tracker.image.motion.foreground import Foreground
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion
from vehicle_pf_tracker.trackers.fusion.unfolding import Unfolding

BOX = np.array([30.0, 24.0])
BEGINS = 60
FRAMES = 120
ROAD = grey_road(400, 120)
BODY = np.random.default_rng(1).integers(160, 255, (24, 120)).astype(np.uint8)


def looks(left, rate=30, stops=FRAMES):
    """Drive to the right and look; `left(time)` px of it are beyond the box's left side.

    Once it `stops`, others pass before it, so that its surface changes as if it drove. Gives time
    and left side in each frame, and the looks up to it.
    """
    foreground, unfolding, right = Foreground(), Unfolding(), 90
    for time in range(FRAMES):
        right += 2 if time < stops else 0
        picture = ROAD.copy()
        width = 30 + left(time)
        # Its surface moves with it.
        body = np.roll(BODY, 2 * max(time - stops, 0), axis=1)
        picture[40:64, right - width : right] = body[:, 120 - width :]
        foreground.keep(SmallGrey(picture, 1.0), stands=True)
        if foreground.is_known:
            position = np.array([right - 15.0, 52.0])
            unfolding = unfolding.looked(foreground, position, BOX, (1.0, 1 / rate))
        yield time, right - width, unfolding


def drive(left, stops=FRAMES):
    """Drive until a side has unfolded; None if none does."""
    found = looks(left, stops=stops)
    return next((one for one in found if one[2].outline is not None), None)


@pytest.mark.parametrize(("rate", "frames"), [(10, 2), (30, 4), (60, 8)])
def test_looks_are_apart_by_time_and_not_by_frames(rate, frames):
    *_, (_, _, unfolding) = looks(lambda time: 12, rate)
    ages = [look.age for look in unfolding.looks]
    apart = frames / rate
    assert -np.diff(ages) == pytest.approx(np.full(len(ages) - 1, apart))
    assert len(ages) >= 5
    assert ages[0] < 2.6


def test_what_moves_around_is_kept_of_the_frames_that_are_looked_at():
    seen = [unfolding.around is not None for _, _, unfolding in looks(lambda time: 12)]
    # A background is known from the 21st frame on, and every fourth one is looked at.
    assert np.flatnonzero(seen).tolist() == list(range(23, FRAMES, 4))


def test_a_side_that_unfolds_is_found_and_followed():
    found = drive(lambda time: min(max(time - BEGINS, 0), 60))
    assert found is not None
    time, left, unfolding = found
    assert BEGINS + 9 <= time < BEGINS + 40
    branch = unfolding.branch(PerspectiveMotion(np.zeros(2), np.array([2.0, 0.0]), 0.0), BOX)
    assert branch is not None
    assert branch.is_proven
    centre, size = branch.box
    assert abs(centre[0] - size[0] / 2 - left) <= 2


def test_what_comes_up_beside_one_that_stands_is_another():
    def left(time):
        return min(max(time - BEGINS, 0), 60)

    assert drive(left, stops=BEGINS + 4) is None
    assert drive(left, stops=BEGINS + 20) is not None


def test_what_joins_at_once_is_another():
    assert drive(lambda time: 40 if time >= BEGINS else 0) is None


def test_a_shadow_that_stays_is_none():
    assert drive(lambda time: 12) is None


def test_the_ghost_of_where_it_stood_is_none():
    foreground, unfolding, found = Foreground(), Unfolding(), []
    for time in range(FRAMES):
        right = 90 + max(time - 30, 0)
        picture = ROAD.copy()
        picture[40:64, right - 30 : right] = BODY[:, 90:]
        foreground.keep(SmallGrey(picture, 1.0), stands=True)
        if foreground.is_known:
            unfolding = unfolding.looked(
                foreground, np.array([right - 15.0, 52.0]), BOX, (1.0, 1 / 30)
            )
            found.append(unfolding.outline)
    assert found
    assert not any(found)


def test_nothing_is_proven_before_an_outline_is_there():
    assert Unfolding().branch(PerspectiveMotion(np.zeros(2), np.zeros(2), 0.0), BOX) is None
