# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The outline of a zone and who is inside, by hand."""

import pytest

from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.counting.zone_watch import ZoneEdge, ZoneWatch
from vehicle_pf_tracker.parameters.counting_plan import CountingZone
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

SQUARE = ((50.0, 50.0), (150.0, 50.0), (150.0, 150.0), (50.0, 150.0))


def edge(*corners):
    return ZoneEdge(CountingZone("zone", corners))


def shown(*ys, begin=0, watch=None):
    """Show a watch a point a second at x = 100; return it, and the directions it has returned."""
    watch = watch or ZoneWatch(edge(*SQUARE))
    found = []
    for second, y in enumerate(ys, start=begin):
        at = FootPoint((100.0, y), second * 10**9, TrackMode.TRACKING, (30.0, 20.0))
        path = RecentPath()
        path.add(at)
        found += watch.follow(at, path)
    return watch, [(direction, at.point[1]) for direction, at in found]


@pytest.mark.parametrize(
    ("corners", "room"),
    [
        # Of 32 points across, the two in the middle are 15.5 / 32 of the way from the border.
        (SQUARE, 48.4375),
        (((50, 50), (250, 50), (250, 110), (50, 110)), 29.0625),
        (((0, 0), (400, 0), (400, 0.5), (0, 0.5)), 1.0),  # nowhere more than a quarter of a px
    ],
)
def test_room_is_the_distance_of_the_middle_from_the_outline(corners, room):
    assert edge(*corners).room == pytest.approx(room)


@pytest.mark.parametrize(
    ("point", "normal"),
    [
        ((100.0, 60.0), (0.0, 1.0)),
        ((140.0, 90.0), (-1.0, 0.0)),
        ((100.0, 140.0), (0.0, -1.0)),
        ((60.0, 90.0), (1.0, 0.0)),
        ((300.0, 60.0), (-1.0, 0.0)),  # the upper side is nearer only where it would be prolonged
        ((-100.0, 60.0), (1.0, 0.0)),
    ],
)
def test_normal_of_the_nearest_side_points_inside(point, normal):
    assert edge(*SQUARE).normal(point) == pytest.approx(normal)


def test_normal_of_a_slanted_side_has_length_one():
    # From (0, 0) to (30, 40), and inside on its right.
    assert edge((0, 0), (30, 40), (-40, 70)).normal((16.0, 20.0)) == pytest.approx((-0.8, 0.6))


def test_a_side_without_length_has_some_normal():
    assert edge((0, 0), (0, 0), (9, 0), (9, 9)).normal((0.0, 0.0)) == (1.0, 0.0)


@pytest.mark.parametrize(("y", "is_inside"), [(50.5, True), (50.0, False), (49.5, False)])
def test_the_first_point_is_inside_without_a_margin(y, is_inside):
    watch = ZoneWatch(edge(*SQUARE))
    assert not watch.is_inside
    assert shown(y, watch=watch) == (watch, [])
    assert watch.is_inside is is_inside
    # The next one says nothing new, within its margin of 2 px.
    shown(101.0 - y, watch=watch)
    assert watch.is_inside is is_inside


def test_a_way_through_between_two_images_enters_and_leaves_on_the_outline():
    _, found = shown(-100.0, 300.0)
    assert [direction for direction, _ in found] == ["entry", "exit"]
    assert [y for _, y in found] == pytest.approx([50.0, 150.0])
    assert shown(-100.0, 49.0)[1] == []


def test_a_gap_is_passed_in_the_way_of_the_line():
    before, _ = shown(0.0, 30.0)
    after, _ = shown(100.0, 110.0, begin=5)
    ((direction, at),) = after.resume(before)
    assert (direction, at.mode) == ("entry", TrackMode.LOST)
    assert after.is_inside


def test_a_way_back_out_in_the_gap_is_measured_across_the_nearest_side():
    before, entered = shown(0.0, 90.0)
    assert [direction for direction, _ in entered] == ["entry"]
    after, _ = shown(20.0, 10.0, begin=5)
    # It was 40 px inside and comes out 30 px beyond the side: more than its height of 20 px.
    ((direction, at),) = after.resume(before)
    assert (direction, at.point) == ("exit", (100.0, pytest.approx(50.0)))
    assert not after.is_inside
