# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Stamps keep a file's intervals and follow the clock of live images; waits double."""

import threading
import time

import pytest

pytest.importorskip("rclpy")

from vehicle_pf_tracker.ros.video_source.outage import Outage
from vehicle_pf_tracker.ros.video_source.pace import SourcePace

MS = 1_000_000


class Clock:
    def __init__(self, *times):
        self.times = list(times)

    def __call__(self):
        return self.times.pop(0)


def test_a_file_keeps_its_intervals_and_is_not_early():
    pace = SourcePace(Clock(5_000 * MS), threading.Event())
    pace.begin(is_live=False)
    began = time.monotonic()
    stamps = [pace.stamp(ms * MS) for ms in (1000, 1040, 1120)]
    assert stamps == [5_000 * MS, 5_040 * MS, 5_120 * MS]
    assert time.monotonic() - began >= 0.12


def test_a_new_pass_begins_at_the_clock_and_never_before_the_last_stamp():
    pace = SourcePace(Clock(5_000 * MS, 5_500 * MS, 4_000 * MS), threading.Event())
    stamps = []
    for _ in range(3):
        pace.begin(is_live=False)
        stamps.append(pace.stamp(1000 * MS))
    assert stamps == [5_000 * MS, 5_500 * MS, 5_500 * MS + 1]


def test_live_images_have_the_clock_but_each_a_time_of_its_own():
    pace = SourcePace(Clock(7, 7, 5, 100), threading.Event())
    pace.begin(is_live=True)
    assert [pace.stamp(0) for _ in range(4)] == [7, 8, 9, 100]


def test_the_end_of_the_process_ends_waits():
    stop = threading.Event()
    stop.set()
    pace = SourcePace(Clock(0), stop)
    pace.begin(is_live=False)
    began = time.monotonic()
    pace.stamp(0)
    pace.stamp(3600 * 1000 * MS)
    assert time.monotonic() - began < 5


class Waits(threading.Event):
    def __init__(self):
        super().__init__()
        self.lengths = []

    def wait(self, timeout=None):
        self.lengths.append(timeout)


def test_waits_for_a_source_double_up_to_half_a_minute_and_begin_anew_with_an_image():
    waits = Waits()
    outage = Outage(waits)
    assert outage.end() is None
    for _ in range(7):
        outage.begin()
        outage.wait()
    assert waits.lengths == [1, 2, 4, 8, 16, 30, 30]
    assert outage.end() >= 0
    assert (outage.next_wait, outage.end()) == (1, None)
