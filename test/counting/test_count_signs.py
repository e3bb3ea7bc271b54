# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What a track may have missed at a line at y = 100, by its ends and a length of 20 px."""

import pytest

from vehicle_pf_tracker.counting.count_signs import Sign, missed_at
from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.line_watch import LineEdge
from vehicle_pf_tracker.parameters.counting_plan import CountingLine
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

EDGE = LineEdge(CountingLine("line", (0.0, 100.0), (320.0, 100.0)))


def missed(begin, end, *, has_ended=True, to_x=100.0, last_height=20.0):
    first = FootPoint((100.0, begin), 0, TrackMode.TRACKING, (30.0, 20.0))
    last = FootPoint((to_x, end), 10**9, TrackMode.TRACKING, (30.0, last_height))
    return missed_at(EDGE, first, last, has_ended=has_ended)


@pytest.mark.parametrize(
    ("begin", "end", "found"),
    [
        (94.0, 106.0, (1, Sign.PASSED)),
        (106.0, 94.0, (-1, Sign.PASSED)),
        (95.0, 105.0, None),  # 10 px are half of its length, and no direction
        (60.0, 80.1, (1, Sign.BROKEN)),  # ended less than 20 px before the line
        (60.0, 80.0, None),
        (119.9, 160.0, (1, Sign.BROKEN)),  # began less than 20 px behind it
        (120.0, 160.0, None),
        (160.0, 119.9, (-1, Sign.BROKEN)),
        (100.0, 130.0, (1, Sign.BROKEN)),  # on the line it is on neither side
        (70.0, 100.0, (1, Sign.BROKEN)),
    ],
)
def test_ends_of_a_track_that_has_ended(begin, end, found):
    assert missed(begin, end) == found


def test_one_that_is_followed_may_cross_yet_and_has_missed_only_what_lies_behind_it():
    assert missed(60.0, 90.0, has_ended=False) is None
    assert missed(94.0, 106.0, has_ended=False) is None
    assert missed(110.0, 140.0, has_ended=False) == (1, Sign.BROKEN)
    assert missed(100.0, 130.0, has_ended=False) == (1, Sign.BROKEN)


def test_lengths_are_those_at_each_end():
    # 30 px before the line: more than 20 px, and less than the 40 px that it has there.
    assert missed(20.0, 70.0, last_height=40.0) == (1, Sign.BROKEN)
    assert missed(20.0, 70.0, last_height=30.0) is None


def test_a_straight_drive_past_the_end_of_the_line_has_missed_nothing():
    # Half of the way to x = 500 is 300, and to 560 it is 330: the line ends at 320.
    assert missed(90.0, 110.0, to_x=500.0) == (1, Sign.PASSED)
    assert missed(90.0, 110.0, to_x=560.0) is None
