# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Occupancy of zones over time, by hand: images 0.5 s apart unless said otherwise."""

import pytest

from vehicle_pf_tracker.counting.zone_occupancy import ZoneOccupancy

S = 10**9
HALF_S = S // 2


def gathered(counts, interval_s=2.0, stamps=None, start=0):
    """Return (start in s, seconds, mean, max, share) of the intervals of a zone."""
    zones = ZoneOccupancy(["a"], interval_s)
    stamps = stamps or [start + index * HALF_S for index in range(len(counts))]
    found = []
    for stamp, count in zip(stamps, counts, strict=True):
        found += zones.add(stamp, {"a": count})
    found += zones.rest()
    assert zones.rest() == []
    assert {one.zone for one in found} <= {"a"}
    rows = [
        (one.start_ns / S, one.occupancy.seconds, one.occupancy.mean, one.occupancy.largest,
         one.occupancy.share)
        for one in found
    ]  # fmt: skip
    return rows, zones.overall["a"]


def test_mean_and_maximum_are_of_intervals_and_of_all():
    rows, overall = gathered([0, 1, 3, 0, 2, 2])
    assert rows == [(0.0, 2.0, 1.0, 3, 0.5), (2.0, 1.0, 2.0, 2, 1.0)]
    assert overall.seconds == 3.0
    assert overall.mean == pytest.approx(8 / 6)
    assert (overall.largest, overall.share) == (3, pytest.approx(4 / 6))


def test_an_image_counts_for_as_long_as_it_stands():
    # 1.5 s without a vehicle, half a second with four.
    rows, _ = gathered([0, 4, 0], stamps=[0, 3 * HALF_S, 4 * HALF_S])
    assert rows[0] == (0.0, 2.0, 1.0, 4, 0.25)


def test_an_image_across_a_boundary_belongs_to_both_intervals():
    rows, _ = gathered([1, 0], interval_s=1.0, stamps=[S // 4, 5 * S // 4])
    assert rows == [(0.0, 0.75, 1.0, 1, 1.0), (1.0, 1.0, 0.25, 1, 0.25), (2.0, 0.25, 0.0, 0, 0.0)]


def test_intervals_begin_at_whole_minutes_of_the_clock():
    rows, _ = gathered([1] * 9, interval_s=60.0, start=1_700_000_037 * S + HALF_S)
    assert [start % 60 for start, *_ in rows] == [0.0, 0.0]
    assert [seconds for _, seconds, *_ in rows] == [2.5, 2.0]


def test_a_gap_is_not_observed():
    rows, overall = gathered([1, 0], interval_s=60.0, stamps=[0, 600 * S])
    assert [(start, seconds) for start, seconds, *_ in rows] == [(0.0, 2.0), (600.0, 2.0)]
    assert overall.mean == 0.5


def test_time_that_goes_back_begins_an_interval_of_its_own():
    rows, overall = gathered([1, 1, 0, 0], stamps=[0, HALF_S, 0, HALF_S])
    assert [(start, mean) for start, _, mean, *_ in rows] == [(0.0, 0.5)]
    rows, overall = gathered([1, 1, 0, 0], stamps=[9 * S, 9 * S + HALF_S, 0, HALF_S])
    assert [(start, mean) for start, _, mean, *_ in rows] == [(8.0, 1.0), (0.0, 0.0)]
    assert overall.seconds == 2.0


def test_one_image_says_nothing_about_time():
    rows, overall = gathered([3])
    assert rows == []
    assert (overall.mean, overall.share) == (0.0, 0.0)
    assert ZoneOccupancy([]).add(0, {}) == []
