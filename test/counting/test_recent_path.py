# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Speed, end and scatter of a path, by hand."""

import math

import pytest

from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.recent_path import RecentPath
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

MS = 1_000_000
START_NS = 1_700_000_000_000_000_000  # stamps of today have no digits left for ms in a float
TRACKING = TrackMode.TRACKING


def path(ys, step_ms, modes=None):
    """Make the path of a box of 40 x 20 px whose foot is at x = 10 and these y."""
    made = RecentPath()
    for index, y in enumerate(ys):
        mode = modes[index] if modes else TRACKING
        stamp_ns = START_NS + round(index * step_ms * MS)
        made.add(FootPoint((10.0, y), stamp_ns, mode, (40.0, 20.0)))
    return made


def test_speed_is_that_of_the_line_through_the_points():
    # Slope of 0, 9, 21, 30 over 0, 1, 2, 3: (-1.5 * 0 - 0.5 * 9 + 0.5 * 21 + 1.5 * 30) / 5 = 10.2.
    assert path([0.0, 9.0, 21.0, 30.0], 100).pixels() == pytest.approx(102.0)


def test_two_points_and_points_at_one_time_have_no_speed():
    assert path([0.0, 10.0], 100).pixels() is None
    assert path([0.0, 10.0, 20.0], 0).pixels() is None
    assert path([0.0, 10.0, 20.0], 100).kmh() is None  # without a road


def test_speed_is_of_the_last_half_second_with_its_ends():
    standing_then_driving = [0.0, 0.0, 0.0, 10.0, 20.0, 30.0, 40.0, 50.0]
    assert path(standing_then_driving, 100).pixels() == pytest.approx(100.0)
    # One image more than half a second back counts no more: of 251 ms apart two are left.
    assert path(standing_then_driving, 251).pixels() is None
    assert path(standing_then_driving, 250).pixels() == pytest.approx(40.0)


def test_a_steady_drive_ends_where_its_line_does():
    # At -30, -10, 10 and 30 ms: the squares sum to 2000 ms^2, the last is 900 ms^2.
    where, deviation = path([0.0, 2.0, 4.0, 6.0], 20).settled()
    assert where == pytest.approx((10.0, 6.0))
    assert deviation == pytest.approx(math.sqrt(1 / 4 + 900 / 2000))
    # The line through 0, 3, 3, 6 rises by 1.8 an image: 3 + 1.5 * 1.8.
    assert path([0.0, 3.0, 3.0, 6.0], 20).settled()[0] == pytest.approx((10.0, 5.7))


def test_three_points_or_predicted_ones_are_no_steady_drive():
    assert path([0.0, 2.0, 4.0], 20).settled() is None
    modes = [TRACKING, TrackMode.OCCLUDED, TRACKING, TRACKING]
    assert path([0.0, 2.0, 4.0, 6.0], 20, modes).settled() is None
    # Only a fifth of a second counts.
    assert path([0.0, 2.0, 4.0, 6.0], 67).settled() is None
    assert path([0.0, 2.0, 4.0, 6.0], 66).settled() is not None
    assert path([0.0, 2.0, 4.0, 6.0], 0).settled() is None


def test_without_points_there_is_no_scatter_and_with_few_the_assumed_one():
    assert RecentPath().scatter((0.0, 1.0)) == 0.0
    # A quarter of the box.
    assert path([0.0], 40).scatter((0.0, 1.0)) == pytest.approx(5.0)
    assert path([0.0, 7.0], 40).scatter((1.0, 0.0)) == pytest.approx(10.0)


def test_scatter_of_three_points_by_hand():
    # The middle is 3 px off the straight drive, whose error has 1 + 1/4 + 1/4 times the variance of
    # a point: 9 / 1.5 = 6, which counts half. The assumed 5 px count twice: (50 + 3) / 2.5.
    assert path([0.0, 3.0, 0.0], 200).scatter((0.0, 1.0)) == pytest.approx(math.sqrt(53 / 2.5))
    # Along x nothing scatters, and the assumed 10 px are left: 200 / 2.5.
    assert path([0.0, 3.0, 0.0], 200).scatter((1.0, 0.0)) == pytest.approx(math.sqrt(80.0))


def test_scatter_of_uneven_times_by_hand():
    # At 0, 200 and 800 ms a steady drive from 0 to 8 is at 2 px; 6 px are 4 off. Shares 1/4, 3/4.
    made = RecentPath()
    for ms, y in ((0, 0.0), (200, 6.0), (800, 8.0)):
        made.add(FootPoint((10.0, y), START_NS + ms * MS, TRACKING, (40.0, 20.0)))
    expected = (50.0 + 0.5 * 16.0 / (1 + 1 / 16 + 9 / 16)) / 2.5
    assert made.scatter((0.0, 1.0)) == pytest.approx(math.sqrt(expected))


def test_slow_waves_scatter_over_a_fifth_of_a_second():
    # At 100 ms apart the wider scale is of two images: 0, 0, 6, 0, 0 has one bend of 6 px there,
    # and bends of -3, 6 and -3 px (9 + 36 + 9 = 54) at one image.
    wide = (50.0 + 0.5 * 36.0 / 1.5) / (2 + 0.5)
    narrow = (50.0 + 0.5 * 54.0 / 1.5) / (2 + 1.5)
    found = path([0.0, 0.0, 6.0, 0.0, 0.0], 100).scatter((0.0, 1.0))
    assert found == pytest.approx(math.sqrt(max(wide, narrow)))


def test_predicted_points_do_not_scatter():
    modes = [TRACKING, TrackMode.OCCLUDED, TRACKING, TRACKING]
    assert path([0.0, 50.0, 0.0, 0.0], 200, modes).scatter((0.0, 1.0)) == pytest.approx(
        math.sqrt(50.0 / 2.5)
    )


def test_four_seconds_and_at_least_24_points_are_remembered():
    # At 5 images a second 24 points are 4.6 s; the wave of the 25th last is forgotten.
    ys = [40.0, *[0.0] * 24]
    assert path(ys, 200).scatter((0.0, 1.0)) == pytest.approx(math.sqrt(50.0 / (2 + 11)))
    # Of images 100 ms apart 41 lie within 4 s, and the wave still counts.
    assert path(ys, 100).scatter((0.0, 1.0)) > math.sqrt(50.0 / (2 + 11))


def test_a_point_is_forgotten_when_it_is_older_than_four_seconds():
    # Of 26 points 161 ms apart the first is 4.025 s old, and the second 3.864 s.
    found = path([40.0, *[0.0] * 25], 161).scatter((0.0, 1.0))
    assert found == pytest.approx(math.sqrt(50.0 / (2 + 11.5)))


def test_a_thousand_points_at_one_time_are_remembered():
    flat = path([0.0] * 1000, 0).scatter((0.0, 1.0))
    assert path([40.0, *[0.0] * 999], 0).scatter((0.0, 1.0)) > flat
    assert path([40.0, *[0.0] * 1000], 0).scatter((0.0, 1.0)) == flat


def test_a_fifth_of_a_second_of_seven_images_is_three():
    # 6 px at three images, 36; one bend of 2 px at one image, and 2, 4 and 2 px at two.
    found = path([0.0, 2.0, 4.0, 6.0, 4.0, 2.0, 0.0], 200 / 3).scatter((0.0, 1.0))
    assert found == pytest.approx(math.sqrt((50.0 + 0.5 * 36.0 / 1.5) / 2.5))


def test_the_end_of_a_path_is_its_latest_point():
    last = FootPoint((10.0, 5.0), START_NS, TRACKING, (40.0, 20.0))
    made = RecentPath()
    assert not made.ends_at(last)
    made.add(last)
    assert made.ends_at(last)
    assert not made.ends_at(FootPoint((10.0, 5.0), START_NS, TRACKING, (40.0, 20.0)))
    made.clear()
    assert not made.ends_at(last)
    assert made.scatter((0.0, 1.0)) == 0.0
