# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The side of a line that a vehicle is on, across a gap between two tracks of it, by hand.

The line is at y = 100, and boxes are 20 px high. A path of one point has the assumed deviation of a
quarter of the box, 5 px: a first passage needs a drive of 25 px (5 of them), a later one 40 px (8).
"""

import pytest

from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.line_watch import LineEdge, LineWatch
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.counting.side_watch import Passage, SideWatch
from vehicle_pf_tracker.parameters.counting_plan import CountingLine
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

SECOND = 10**9
MODES = {"T": TrackMode.TRACKING, "O": TrackMode.OCCLUDED}
EDGE = LineEdge(CountingLine("line", (0.0, 100.0), (320.0, 100.0)))


def foot(y, second, mode="T", x=100.0, deviation=0.0):
    covariance = (0.0, 0.0, deviation**2)
    return FootPoint((x, y), second * SECOND, MODES[mode], (30.0, 20.0), covariance)


class Track:
    """A watch that is shown a point a second, each as if the path began with it."""

    def __init__(self, ys=(), modes="", *, begin=0, x=100.0, watch=None):
        self.watch = watch or SideWatch(EDGE)
        self.second = begin
        self.x = x
        self.passed = []
        self.on(ys, modes)

    def on(self, ys, modes="", deviation=0.0):
        """Go on along these rows; return what is passed."""
        found = []
        for y, mode in zip(ys, modes or "T" * len(ys), strict=True):
            at = foot(y, self.second, mode, self.x, deviation)
            path = RecentPath()
            path.add(at)
            passed = self.watch.follow(at, path)
            found += [] if passed in (None, []) else [passed]
            self.second += 1
        self.passed += found
        return found

    def resume(self, before):
        return self.watch.resume(before.watch)


def sides(passages):
    return [passage.side for passage in passages]


def test_a_point_is_clear_of_the_line_beyond_its_margin():
    assert [Track([y]).watch.side for y in (97.9, 98, 100, 102, 102.1)] == [-1, 0, 0, 0, 1]


def test_a_first_passage_takes_five_deviations_and_a_later_one_eight():
    assert Track([85]).on([109.9]) == []
    track = Track([85])
    assert sides(track.on([110])) == [1]
    assert track.on([70.1]) == []
    assert sides(track.on([70])) == [-1]


def test_a_prediction_must_go_back_beyond_its_own_deviation():
    # Four of 20 px are 80 px: from 30 px behind the line to 50 px before it.
    for y, passed in ((51, []), (50, [-1])):
        track = Track([60, 130])
        assert sides(track.on([y], "O", deviation=20.0)) == passed


@pytest.mark.parametrize(("ys", "side"), [([130, 130, 130, 90], 1), ([70, 70, 70, 110], -1)])
def test_one_point_beyond_the_line_is_not_the_end_of_a_steady_drive(ys, side):
    # The line through the four ends 2 px on the side where three of them are.
    watch, path = SideWatch(EDGE), RecentPath()
    for index, y in enumerate(ys):
        at = FootPoint((100.0, y), index * SECOND // 25, TrackMode.TRACKING, (30.0, 20.0))
        path.add(at)
        assert watch.follow(at, path) is None
    assert watch.side == side


def test_a_first_side_that_is_predicted_is_no_forecast_of_a_passage():
    track = Track([101])
    assert track.on([110], "O") == []
    assert track.watch.side == 1
    # A forecast would be refuted by any clear point; 3 px are no drive.
    assert track.on([97]) == []
    assert track.watch.side == 1


def test_a_straight_drive_through_the_gap_is_a_passage_that_was_not_seen():
    # From -4 px at 2 s to 12 px at 6 s: a quarter of the way is 1 s.
    before = Track([60, 80, 96])
    after = Track([112], begin=6, x=140.0)
    assert after.resume(before) == Passage(
        1, FootPoint((110.0, 100.0), 3 * SECOND, TrackMode.LOST, (30.0, 20.0))
    )
    # It is the vehicle's first passage, after which the 27 px back to 85 are not enough.
    assert after.on([85]) == []


def test_past_the_end_of_the_line_there_is_no_passage_in_the_gap():
    # A quarter of the way from x = 100 to 960 is 315, and to 1000 it is 325: the line ends at 320.
    assert Track([112], begin=6, x=960.0).resume(Track([60, 80, 96])).at.point == (315.0, 100.0)
    assert Track([112], begin=6, x=1000.0).resume(Track([60, 80, 96])) is None


def test_a_last_point_in_the_noise_beyond_the_edge_makes_the_first_one_the_passage():
    for last in (100.0, 101.0):
        before = Track([60, 80, last])
        passage = Track([110, 120], begin=6).resume(before)
        assert (passage.side, passage.at.point, passage.at.stamp_ns) == (1, (100, 110), 6 * SECOND)


def test_a_first_point_on_the_line_itself_is_where_it_passed():
    assert Track([100, 110], begin=6).resume(Track([60, 80, 96])).at.point == (100.0, 100.0)


def test_a_track_that_was_on_no_clear_side_is_nothing_to_go_on_from():
    after = Track([110, 120])
    assert after.resume(Track([101])) is None
    assert after.watch.side == 1
    assert sides(after.on([90])) == [-1]  # 30 px, its first passage


def test_the_side_of_before_stands_until_a_point_is_clear():
    after = Track([100], begin=3)
    assert after.resume(Track([60, 90])) is None
    assert after.watch.side == -1
    # 3 px behind the line, 43 px from the furthest point before it.
    assert sides(after.on([103])) == [1]
    near = Track([100], begin=3)
    near.resume(Track([88, 90]))
    assert near.on([112]) == []  # 24 px from 88
    assert sides(near.on([114])) == [1]


def test_passages_of_both_tracks_are_those_of_the_vehicle():
    before = Track([60, 90, 120])
    assert sides(before.passed) == [1]
    after = Track([120], begin=6)
    assert after.resume(before) is None
    # 25 px would do for a first passage, but it has passed before.
    assert after.on([95]) == []
    assert after.on([81]) == []
    assert sides(after.on([80])) == [-1]
    alone = Track([120], begin=6)
    assert sides(alone.on([95])) == [-1]


@pytest.mark.parametrize(("first", "passed"), [(86.0, False), (85.0, True)])
def test_back_in_the_gap_it_must_have_driven_its_own_length(first, passed):
    # It was seen until 5 px behind the line: 5 and 15 px are its length of 20.
    before = Track([60, 130, 105])
    passage = Track([first, 80], begin=6).resume(before)
    assert (passage is not None) is passed
    # Without a passage before it is the first, of any length.
    assert Track([105, 120], begin=6).resume(Track([60, 95])).side == 1


def test_a_forecast_that_the_next_track_refutes_is_not_returned_twice():
    before = Track([70, 90, 110], "TTO")
    assert sides(before.passed) == [1]
    after = Track([90], begin=3)
    assert after.resume(before) is None
    assert after.watch.side == -1
    # The passage that was returned too early comes now, and the way back is one of its own.
    assert after.on([120]) == []
    assert after.watch.side == 1
    assert after.on([95]) == []
    assert sides(after.on([70])) == [-1]


def test_a_forecast_goes_over_to_a_track_that_is_not_clear_yet():
    before = Track([70, 90, 110], "TTO")
    after = Track([101], begin=3)
    assert after.resume(before) is None
    assert after.watch.side == 1
    after.on([95])
    assert after.watch.side == -1  # seen there after all, however little it has driven
    assert after.on([125]) == []  # returned before
    assert after.watch.side == 1


def test_what_the_track_before_followed_since_this_one_began_was_something_else():
    # It went over at 4 s, when this track had been before the line since 3 s.
    before = Track([60, 70, 80, 90, 120])
    assert sides(before.passed) == [1]
    after = Track([90], begin=3)
    assert after.resume(before) is None
    assert after.on([125]) == []  # the vehicle passes once
    assert after.watch.side == 1
    # At the same time it is what this track has come back from.
    assert Track([75], begin=4).resume(before).side == -1


def test_a_side_that_this_track_came_to_by_itself_is_its_own_passage():
    after = Track([80, 120], begin=6)
    assert sides(after.passed) == [1]
    # It began before the line, as the track before ended there.
    assert after.resume(Track([60, 70])) is None
    assert after.on([90]) == []
    assert sides(after.on([70])) == [-1]


def test_a_watch_that_saw_nothing_has_no_ends():
    hidden = Track([90, 110], "OO")
    assert hidden.watch.ends is None
    seen = Track([80, 90, 110], "TTO")
    assert [at.point[1] for at in seen.watch.ends] == [80, 90]


def test_a_line_counts_the_passage_of_the_gap_and_none_that_was_counted_before():
    def line(ys, begin=0, modes=""):
        return Track(ys, modes, begin=begin, watch=LineWatch(EDGE))

    (passage,) = line([112, 120], begin=6).resume(line([60, 80, 96]))
    assert (passage[0], passage[1].point) == ("in", (100.0, 100.0))
    there_and_back = line([60, 120, 60])
    assert [found[0][0] for found in there_and_back.passed] == ["in", "out"]
    again = line([130, 140], begin=6)
    assert again.resume(there_and_back) == []
    assert again.on([60, 130]) == []


def test_a_line_has_nothing_missed_by_what_was_never_seen():
    hidden = Track([80, 90], "OO", watch=LineWatch(EDGE))
    assert hidden.watch.missed(has_ended=True) is None
