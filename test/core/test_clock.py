# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

from vehicle_pf_tracker.core.clock import StampClock, StampEvent, Tick

MS = 1_000_000


def ticks(clock, milliseconds):
    return [clock.tick(t * MS) for t in milliseconds]


def test_with_a_given_rate_elapsed_is_the_interval_over_the_period():
    assert [t.elapsed for t in ticks(StampClock(10.0), [0, 100, 300, 350])] == pytest.approx(
        [1.0, 1.0, 2.0, 0.5]
    )


def test_without_one_the_median_of_ten_intervals_is_learned():
    clock = StampClock(0.0)
    # Nine intervals of 50 ms and one of 500 ms: the median is 50.
    learning = ticks(clock, [0, 50, 100, 600, 650, 700, 750, 800, 850, 900, 950])
    assert [t.elapsed for t in learning] == [1.0] * 11
    assert clock.period == pytest.approx(0.05)
    assert clock.tick(1050 * MS).elapsed == pytest.approx(2.0)


def test_the_learned_rate_does_not_creep():
    clock = StampClock(0.0)
    ticks(clock, range(0, 600, 50))
    assert [t.elapsed for t in ticks(clock, range(650, 2000, 100))][1:] == pytest.approx([2.0] * 13)


def test_time_that_goes_back_is_told():
    clock = StampClock(10.0)
    ticks(clock, [2000, 2100])
    assert clock.tick(1100 * MS).event is StampEvent.JUMP_BACK
    assert clock.tick(1200 * MS).elapsed == pytest.approx(1.0)


def test_less_than_a_second_back_a_clock_was_set():
    clock = StampClock(10.0)
    ticks(clock, [2000, 2100])
    assert clock.tick(1101 * MS) == Tick(1.0, StampEvent.SET_BACK)
    assert clock.tick(1201 * MS) == Tick(pytest.approx(1.0))


def test_a_frame_delivered_twice_takes_no_time_but_a_camera_without_a_clock_runs_on():
    clock = StampClock(10.0)
    repeats = ticks(clock, [0, 0, 0, 0])
    assert [t.elapsed for t in repeats] == [1.0, 0.0, 1.0, 1.0]
    assert [t.event for t in repeats[1:]] == [StampEvent.REPEATED] * 3
    assert clock.tick(100 * MS) == type(repeats[0])(pytest.approx(1.0))


def test_after_a_jump_back_a_repeat_is_a_first_one_again():
    repeats = ticks(StampClock(10.0), [1000, 1000, 500, 500])
    assert [t.elapsed for t in repeats] == [1.0, 0.0, 1.0, 0.0]


def test_a_gap_counts_as_five_seconds_at_most():
    clock = StampClock(10.0)
    tick = ticks(clock, [0, 86_400_000])[-1]
    assert tick.event is StampEvent.GAP
    assert tick.elapsed == pytest.approx(50.0)
    assert ticks(StampClock(0.0), [0, 86_400_000])[-1].elapsed == 1.0


def test_the_rate_can_be_given_and_taken_back_while_running():
    clock = StampClock(0.0)
    ticks(clock, range(0, 1200, 100))
    clock.set_frame_rate(20.0)
    assert clock.tick(1200 * MS).elapsed == pytest.approx(2.0)
    clock.set_frame_rate(0.0)
    assert clock.tick(1300 * MS).elapsed == pytest.approx(1.0)


def test_a_second_repeat_after_a_good_stamp_is_a_first_one_again():
    elapsed = [t.elapsed for t in ticks(StampClock(10.0), [0, 0, 100, 100])]
    assert elapsed == pytest.approx([1.0, 0.0, 1.0, 0.0])
