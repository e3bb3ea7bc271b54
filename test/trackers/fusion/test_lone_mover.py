# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Things that move, around a vehicle of 20 x 20 px that was lost at (100, 100)."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.lone_mover import LoneMover, Mover

VEHICLE = np.array([100.0, 100.0]), np.array([20.0, 20.0])
IMAGE = np.array([640.0, 480.0])


def square(x, y=300.0, side=20.0):
    """A box around (x, y)."""
    return np.array([[x - side / 2, y - side / 2], [x + side / 2, y + side / 2]])


def boxes(*squares):
    return np.array(squares).reshape(-1, 2, 2)


def same(_centre, _size):
    return 0.5


def other(_centre, _size):
    return 1.5


def watched(search, frames, things=(), paint=same):
    """Let so many frames pass; `things` gives the middles (x, y) of what moves in each."""
    for number in range(frames):
        search = search.passed(1.0)
        seen = boxes(*(square(*thing(number)) for thing in things))
        if search.is_due:
            search = search.observed(seen, VEHICLE, IMAGE, paint)
    return search


def driving(number):
    return 200.0 + 3 * number, 300.0


def lost_for_long():
    return watched(LoneMover(), 59)


def test_it_is_found_once_motion_and_paint_are_proven():
    """By its eighth frame it has driven 21 px, a size; then its paint counts for three frames."""
    assert watched(lost_for_long(), 9, [driving]).found() is None
    found = watched(lost_for_long(), 10, [driving]).found()
    assert found.sides == pytest.approx(square(227.0))


@pytest.mark.parametrize(
    ("things", "paint"),
    [
        ([driving], other),
        ([lambda number: (200.0 + 2 * number, 300.0)], same),  # 18 px in ten frames, no size
        ([driving, lambda number: (400.0 + 3 * number, 300.0)], same),  # one of two
        ([lambda number: (10.0 + 3 * number, 300.0)], same),  # has come in by the border
    ],
)
def test_it_is_not_found(things, paint):
    assert watched(lost_for_long(), 10, things, paint).found() is None


@pytest.mark.parametrize(("side", "is_found"), [(7, False), (8, True), (59, True), (61, False)])
def test_its_area_is_bounded_by_the_vehicle_s(side, is_found):
    """.15 of 20 x 20 px is 7.75 x 7.75, and nine times as much is 60 x 60."""
    search = lost_for_long()
    for number in range(11):
        seen = boxes(square(200.0 + side / 7.5 * number, side=float(side)))
        search = search.passed(1.0).observed(seen, VEHICLE, IMAGE, same)
    assert (search.found() is not None) == is_found


def test_nothing_is_looked_for_where_another_moved_as_it_was_lost():
    """A middle 31 px aside is beyond one and a half sizes; one of 29 px may be the vehicle."""
    for aside, is_due in ((29.0, True), (31.0, False)):
        search = watched(LoneMover(), 8, [lambda _, x=aside: (100.0 + x, 100.0)])
        assert watched(search, 52).is_due == is_due
    search = watched(LoneMover(), 8, [lambda _: (131.0, 100.0)], other)
    assert watched(search, 52).is_due


def test_looks_are_for_the_first_eight_frames_and_after_sixty():
    due = []
    search = LoneMover()
    for _ in range(61):
        search = search.passed(1.0)
        due.append(search.is_due)
    assert due == [True] * 8 + [False] * 51 + [True] * 2


def test_its_way_is_against_the_background():
    """What stands moves in the image with a camera that pans."""
    pan = CameraMotion(np.eye(2), np.array([3.0, 0.0]))
    search = lost_for_long()
    for number in range(12):
        seen = boxes(square(*driving(number)))
        search = search.moved(pan).passed(1.0).observed(seen, VEHICLE, IMAGE, same)
    assert search.movers[0].start == pytest.approx([200.0 + 33, 300.0])
    assert search.found() is None


def test_one_that_flickers_is_followed_for_a_frame():
    search = watched(lost_for_long(), 5, [driving])
    assert len(watched(search, 1).movers) == 1
    assert len(watched(search, 2).movers) == 0


def test_a_box_that_grows_at_once_is_another_one():
    """2.5 times the area of 20 x 20 px is that of a side of 31.6 px."""
    mover = Mover(square(200.0), np.array([200.0, 300.0]))
    assert mover.next(boxes(square(200.0, side=31.0))) == 0
    assert mover.next(boxes(square(200.0, side=32.0))) is None
    assert mover.next(boxes(square(230.0))) is None
    assert mover.next(boxes()) is None


def test_the_filter_is_begun_anew_until_it_agrees():
    """Boxes of 20 px that are 5 px apart share 15 of 25, an overlap of .6; 6 px apart, .54."""
    mover = Mover(square(200.0), np.array([200.0, 300.0]))
    search = LoneMover(followed=mover)
    seen = boxes(square(203.0))
    size = np.array([20.0, 20.0])
    anew = search.compared(seen, (np.array([209.0, 300.0]), size))
    assert anew.agreed == 0
    assert anew.followed.sides == pytest.approx(square(203.0))
    assert search.compared(seen, None).agreed == 0
    agrees = search.compared(seen, (np.array([207.9, 300.0]), size))
    assert agrees.agreed == 1
    for _ in range(6):
        agrees = agrees.compared(seen, (np.array([203.0, 300.0]), size))
    assert agrees.agreed == 7
    assert agrees.compared(seen, (np.array([203.0, 300.0]), size)) == LoneMover()


@pytest.mark.parametrize(("aside", "agrees"), [(7.0, True), (7.2, False)])
def test_a_part_inside_the_box_is_the_vehicle_s_own(aside, agrees):
    """Of 10 px all but 2 are inside the box's 20 up to 7 px from its middle."""
    search = LoneMover(followed=Mover(square(200.0, side=10.0), np.array([200.0, 300.0])))
    seen = boxes(square(200.0, side=10.0))
    compared = search.compared(seen, (np.array([200.0 + aside, 300.0]), np.array([20.0, 20.0])))
    assert (compared.agreed == 1) == agrees


def test_nothing_is_left_to_follow_once_it_is_gone():
    search = LoneMover(followed=Mover(square(200.0), np.array([200.0, 300.0])))
    assert search.compared(boxes(), None) == LoneMover()
