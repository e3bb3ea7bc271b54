# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Doubts about crossings, by hand: vehicles of 40 px at one line."""

from dataclasses import replace

import pytest

from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.plausibility import Life, Plausibility
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

SECOND = 10**9
TRACKING = TrackMode.TRACKING
OCCLUDED = TrackMode.OCCLUDED
SIZE = (40.0, 20.0)


def crossing(identity, *, direction="in", speed=100.0, x=100.0, mode=TRACKING, at=None):
    stamp_ns = round((identity if at is None else at) * 10 * SECOND)
    return Crossing(stamp_ns, "line", direction, identity, "car", mode, speed, None, (x, 50.0))


def life(begin, end, *, first=(0.0, 50.0), last=(0.0, 90.0), detected=10, path=None):
    """Make a life of ten images from `begin` to `end`, s."""
    points = [
        FootPoint(point, round(stamp * SECOND), TRACKING, SIZE)
        for point, stamp in ((first, begin), (last, end))
    ]
    return Life(*points, path or RecentPath(), images=10, detected=detected)


def taken(place, count, **facts):
    """Let `count` vehicles cross, which nobody doubts, each 10 s after the last."""
    for number in range(1, count + 1):
        passing = crossing(number, **facts)
        assert place.doubt(passing, life(10 * number - 1, 10 * number + 1)) == ""


@pytest.mark.parametrize(
    ("others", "speed", "doubt"),
    [(5, 300.0, ""), (5, 300.1, "faster"), (4, 900.0, ""), (5, None, "")],
)
def test_more_than_three_times_the_median_of_five_is_faster(others, speed, doubt):
    place = Plausibility()
    taken(place, others)
    assert place.doubt(crossing(9, speed=speed), life(89, 91)) == doubt


def test_crossings_without_a_speed_and_of_the_other_direction_are_no_measure():
    place = Plausibility()
    taken(place, 4)
    place.doubt(crossing(5, speed=None), life(49, 51))
    place.doubt(crossing(6, direction="out"), life(59, 61))
    assert place.doubt(crossing(9, speed=900.0), life(89, 91)) == ""


def test_a_doubted_crossing_is_no_measure_of_later_ones():
    place = Plausibility()
    taken(place, 5)
    # Were the fast ones remembered, their speed would soon be the median.
    for number in range(6, 16):
        fast = crossing(number, speed=900.0)
        assert place.doubt(fast, life(10 * number - 1, 10 * number + 1)) == "faster"


@pytest.mark.parametrize(
    ("others", "detected", "x", "doubt"),
    [
        (5, 4, 100.0, "against"),
        (4, 4, 100.0, ""),  # too few to know the place
        (5, 5, 100.0, ""),  # detected in half of its images
        (5, 4, 159.0, "against"),  # within 1.5 boxes of 40 px
        (5, 4, 160.0, ""),  # another lane
    ],
)
def test_a_vague_vehicle_against_five_others_beside_it(others, detected, x, doubt):
    place = Plausibility()
    taken(place, others)
    back = crossing(9, direction="out", x=x)
    assert place.doubt(back, life(89, 91, detected=detected)) == doubt


def test_one_that_went_the_same_way_before_is_enough():
    place = Plausibility()
    taken(place, 1, direction="out")
    for number in range(2, 8):
        place.doubt(crossing(number), life(10 * number - 1, 10 * number + 1))
    assert place.doubt(crossing(9, direction="out"), life(89, 91, detected=4)) == ""


def test_other_places_are_judged_by_themselves():
    place = Plausibility()
    taken(place, 5)
    elsewhere = replace(crossing(9, speed=900.0), place="other")
    assert place.doubt(elsewhere, life(89, 91)) == ""


@pytest.mark.parametrize(
    ("begin", "x", "follows"),
    [
        (2.0, 39.0, True),  # 39 px from where the first was last seen, and it stood still
        (2.0, 40.0, False),
        (1.0, 39.0, False),  # at the same time
        (0.9, 39.0, False),
    ],
)
def test_a_life_precedes_one_that_begins_where_it_ended(begin, x, follows):
    before = life(0.0, 1.0)
    after = life(begin, begin + 1, first=(x, 90.0))
    assert before.precedes(after) is follows


def test_a_life_moves_on_until_the_next_begins():
    # 20 px/s: after one second 20 px and another 19 px apart are still less than 40.
    path = RecentPath()
    for tenth in range(4):
        path.add(FootPoint((0.0, 84.0 + 2 * tenth), tenth * SECOND // 10, TRACKING, SIZE))
    before = life(0.0, 1.0, path=path)
    assert before.precedes(life(2.0, 3.0, first=(19.0, 90.0)))
    assert not before.precedes(life(2.0, 3.0, first=(21.0, 90.0)))
    assert not before.precedes(life(3.0, 4.0, first=(19.0, 90.0)))


def twins(*, direction="in", identity=2, mode=OCCLUDED, begin=2.0, later=0.1, x=100.0):
    """Let a first vehicle cross, seen from 0 to 1 s, and then the second; return its doubt."""
    place = Plausibility()
    assert place.doubt(crossing(1, at=0.2, mode=mode), life(0.0, 1.0)) == ""
    second = crossing(identity, direction=direction, at=0.2 + later, x=x)
    return place.doubt(second, life(begin, begin + 1, first=(300.0, 90.0)))


def test_a_vehicle_that_was_predicted_over_the_line_and_born_again_is_counted_once():
    assert twins(later=0.01) == "twice"
    # 100 px/s for 0.5 s are 50 px, within 1.5 boxes; 0.6 s are 60 px, and no longer.
    assert [twins(later=0.05), twins(later=0.06)] == ["twice", ""]
    # 30 px on and 51 or 52 px aside: 59.2 and 60.03 px.
    assert [twins(later=0.03, x=151.0), twins(later=0.03, x=152.0)] == ["twice", ""]


def test_what_cannot_be_the_same_vehicle():
    assert twins(later=0.01, direction="out") == ""
    assert twins(later=0.01, identity=1) == ""
    assert twins(later=0.01, mode=TRACKING) == ""  # both were seen to cross
    assert twins(later=0.01, begin=1.0) == ""  # both were seen at 1 s


def test_one_that_ended_when_the_other_began_was_seen_at_the_same_time():
    for end, doubt in ((2.0, ""), (1.9, "twice")):
        place = Plausibility()
        assert place.doubt(crossing(1, at=0.2, mode=OCCLUDED), life(2.0, 3.0)) == ""
        second = crossing(2, at=0.201, mode=OCCLUDED)
        assert place.doubt(second, life(1.0, end, first=(300.0, 90.0))) == doubt


def test_twins_without_a_speed_have_not_driven():
    place = Plausibility()
    first = crossing(1, at=0.2, mode=OCCLUDED, speed=None)
    assert place.doubt(first, life(0.0, 1.0)) == ""
    # 100 s later: at 1 px/s they would be 100 px apart, and within 1.5 boxes they are 60.
    second = crossing(2, at=10.2, mode=OCCLUDED, speed=None)
    assert place.doubt(second, life(2.0, 3.0, first=(300.0, 90.0))) == "twice"


def test_images_are_counted_and_the_last_point_is_one_that_was_seen():
    lived = life(0.0, 1.0, detected=0)
    hidden = FootPoint((5.0, 95.0), 2 * SECOND, OCCLUDED, (60.0, 30.0))
    lived.add(hidden, is_detected=False)
    assert (lived.images, lived.detected, lived.side) == (11, 0, 40.0)
    lived.add(replace(hidden, mode=TRACKING), is_detected=True)
    assert (lived.images, lived.detected, lived.side) == (12, 1, 60.0)
