# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

pytest.importorskip("rclpy")

from vehicle_pf_tracker.ros.replay.pace import ReplayPace
from vehicle_pf_tracker.ros.replay.starting_target import nearest_frame


class Watch:
    """A clock that is set by hand."""

    now = 100.0

    def __call__(self):
        return self.now


@pytest.mark.parametrize(("rate", "due"), [(1.0, 103.0), (2.0, 101.5), (0.5, 106.0)])
def test_messages_are_due_at_their_distance_over_the_rate(rate, due):
    pace = ReplayPace(rate, Watch())
    assert pace.due(7_000_000_000) == 100.0
    assert pace.due(10_000_000_000) == due


def test_without_a_rate_everything_is_due_now():
    watch = Watch()
    pace = ReplayPace(None, watch)
    assert pace.due(0) == 100.0
    watch.now = 100.5
    assert pace.due(10**12) == 100.5
    assert pace.log_time_ns() == 10**12


def test_log_time_runs_with_the_rate_up_to_the_next_message():
    watch = Watch()
    pace = ReplayPace(2.0, watch)
    assert pace.log_time_ns() is None
    pace.due(1_000_000_000)
    pace.due(4_000_000_000)
    watch.now = 101.0
    assert pace.log_time_ns() == 3_000_000_000
    watch.now = 109.0
    assert pace.log_time_ns() == 4_000_000_000


def test_a_loop_takes_the_first_log_time_as_now_again():
    watch = Watch()
    pace = ReplayPace(1.0, watch)
    pace.due(0)
    pace.due(5_000_000_000)
    watch.now = 105.0
    pace.restart()
    assert pace.log_time_ns() is None
    assert pace.due(0) == 105.0


def test_time_stands_still_in_a_pause_and_goes_on_from_there():
    watch = Watch()
    pace = ReplayPace(2.0, watch)
    pace.due(0)
    pace.due(8_000_000_000)
    watch.now = 101.0
    pace.set_paused(True)
    watch.now = 150.0
    assert pace.is_paused
    assert pace.log_time_ns() == 2_000_000_000
    pace.set_paused(False)
    assert not pace.is_paused
    assert pace.due(8_000_000_000) == 100.0 + 4.0 + 49.0
    watch.now = 151.0
    assert pace.log_time_ns() == 4_000_000_000
    pace.set_paused(False)  # of none changes nothing
    assert pace.log_time_ns() == 4_000_000_000


def test_a_replay_that_begins_paused_begins_with_its_end():
    watch = Watch()
    pace = ReplayPace(1.0, watch)
    pace.set_paused(True)
    pace.due(5_000_000_000)
    watch.now = 130.0
    pace.set_paused(False)
    assert pace.due(5_000_000_000) == 130.0


@pytest.mark.parametrize(
    ("stamps", "stamp", "frame"),
    [
        ([100, 200, 300], 100, 1),
        ([100, 200, 300], 300, 3),
        ([100, 200, 300], 95, 1),
        ([100, 200, 300], 149, None),
        ([100, 110, 120], 115, 2),  # of two equally near ones the earlier
        ([100, 110, 120], 116, 3),
        ([], 100, None),
    ],
)
def test_truth_belongs_to_the_nearest_image(stamps, stamp, frame):
    assert nearest_frame(stamps, stamp, limit_ns=10) == frame


def test_no_image_beyond_the_next_is_read():
    stamps = iter([100, 200, 300, 400])
    assert nearest_frame(stamps, 100, limit_ns=10) == 1
    assert next(stamps) == 300
