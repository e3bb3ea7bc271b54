# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import dataclasses

import numpy as np
import pytest
from drive import box_of, drive, frame_of, stamp_of, truth_of
from failing import ERROR, failing

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker, with_target
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE
from vehicle_pf_tracker.trackers.attempts import TrackerError
from vehicle_pf_tracker.trackers.registry import VARIANTS

PF = VARIANTS["pf"]
TARGET = with_target(SessionParameters(), box_of(0))


def tracker(settings=None, **options):
    return OfflineTracker(PF, PF.parameters(sigma=4.0), settings, **options)


def without_time(rows):
    return [dataclasses.replace(row, step_ms=None) for row in rows]


def modes(rows):
    return [row.mode for row in rows]


def test_one_row_per_frame_and_the_vehicle_is_followed():
    rows = list(tracker(TARGET).rows(drive()))
    assert [(row.frame, row.stamp_ns) for row in rows] == [(i + 1, stamp_of(i)) for i in range(20)]
    for index, row in enumerate(rows):
        assert np.hypot(*np.subtract(row.position, box_of(index).centre)) < 5


def test_a_tracker_that_fails_twice_starts_anew_and_the_run_goes_on(monkeypatch):
    monkeypatch.setattr(PF.tracker, "step", failing(PF.tracker.step, {4, 5}))
    made = tracker(TARGET)
    rows = list(made.rows(drive()))
    assert modes(rows) == ["TRACKING"] * 5 + [REJECTED_MODE] + ["TRACKING"] * 14
    assert np.hypot(*np.subtract(rows[-1].position, box_of(19).centre)) < 5
    assert made.notices == [
        f"frame 6 was rejected: {ERROR}",
        f"frame 7: the tracker failed twice in a row and has started anew: {ERROR}",
    ]


def test_a_broken_tracker_ends_the_run(monkeypatch):
    made = tracker(TARGET)
    rows = made.rows(drive())
    next(rows)
    monkeypatch.setattr(PF.tracker, "step", lambda *_: 1 / 0)
    monkeypatch.setattr(PF.tracker, "start", lambda *_: 1 / 0)
    assert next(rows).mode == REJECTED_MODE
    with pytest.raises(TrackerError, match="division by zero"):
        next(rows)


def test_the_same_seed_gives_the_same_rows_and_another_seed_others():
    def rows(seed):
        made = OfflineTracker(PF, PF.parameters(seed=seed), TARGET)
        return without_time(made.rows(drive()))

    assert rows(1) == rows(1)
    assert rows(1) != rows(2)


def test_frames_before_the_first_truth_are_waited_through():
    made = tracker(first_truth=truth_of(4))
    rows = list(made.rows(drive(8)))
    assert modes(rows) == [WAITING_MODE] * 4 + ["TRACKING"] * 4
    assert rows[3].position is None
    assert rows[4].position == box_of(4).centre
    assert made.start_frame == 5


def test_waiting_changes_nothing_about_the_numbers():
    late = list(tracker(first_truth=truth_of(4)).rows(drive()))[4:]
    cut = tracker(with_target(SessionParameters(), box_of(4))).rows(drive()[4:])
    assert [row.position for row in late] == [row.position for row in cut]


@pytest.mark.parametrize("shift_ms", [-9, 0, 9])
def test_the_first_truth_belongs_to_the_nearest_frame(shift_ms):
    shifted = Truth(stamp_of(3) + shift_ms * 1_000_000, box_of(3), Occlusion.NONE)
    made = tracker(first_truth=shifted)
    list(made.rows(drive(6)))
    assert made.start_frame == 4


def test_a_truth_that_belongs_to_no_frame_is_an_error():
    far = Truth(stamp_of(3) + 20_000_000, box_of(3), Occlusion.NONE)
    with pytest.raises(InputError, match=r"no image is within 0\.01 s .* at 1\.140 s"):
        list(tracker(first_truth=far).rows(drive(6)))


def test_a_given_target_goes_before_the_truth():
    made = tracker(TARGET, first_truth=truth_of(4))
    assert next(made.rows(drive(6))).position == box_of(0).centre
    assert made.start_frame == 1


def test_a_target_outside_the_image_is_an_error():
    outside = with_target(SessionParameters(), Box(500, 500, 20, 20))
    with pytest.raises(InputError, match="centre outside the image"):
        list(tracker(outside).rows(drive(3)))


def test_without_a_target_all_frames_wait():
    made = tracker()
    assert modes(made.rows(drive(3))) == [WAITING_MODE] * 3
    assert made.start_frame is None


def test_a_frame_that_cannot_be_used_is_rejected_and_the_track_goes_on():
    frames = drive(12)
    frames[6] = (stamp_of(6), np.zeros((5, 5), np.uint8))
    made = tracker(TARGET)
    rows = list(made.rows(frames))
    assert modes(rows) == ["TRACKING"] * 6 + [REJECTED_MODE] + ["TRACKING"] * 5
    assert rows[6].position is None
    assert abs(rows[11].x - box_of(11).centre[0]) < 5
    assert made.notices == [
        "frame 7 was rejected: a frame must be a non-empty (height, width, 3) array of uint8, "
        "got shape (5, 5) of uint8"
    ]


def test_time_that_jumps_back_starts_on_the_first_truth_again():
    frames = [*drive(27), *drive(6)]  # the first pass takes more than a second
    made = tracker(first_truth=truth_of(0))
    rows = list(made.rows(frames))
    assert rows[27].mode == REJECTED_MODE  # one image alone might be a stray
    assert [row.position for row in rows[1:6]] == [row.position for row in rows[28:]]
    assert made.notices[0].startswith("frame 28 was rejected: the image's stamp goes back by")
    assert made.notices[1:] == ["frame 29: time jumped back"]


def test_a_stray_before_the_start_is_rejected_too():
    frames = drive(4)
    frames[1] = (stamp_of(1), np.zeros((9, 9, 3), np.uint8))
    made = tracker(first_truth=truth_of(1))
    assert modes(made.rows(frames)) == [WAITING_MODE, REJECTED_MODE, "TRACKING", "TRACKING"]


def test_frames_are_taken_one_by_one():
    taken = []

    def frames():
        for index in range(10):
            taken.append(index)
            yield stamp_of(index), frame_of(index)

    next(tracker(TARGET).rows(frames()))
    assert len(taken) <= 2


def test_an_image_that_could_not_be_read_is_rejected_and_the_track_goes_on():
    frames = [
        (stamp, None if index == 4 else frame) for index, (stamp, frame) in enumerate(drive())
    ]
    rows = list(tracker(TARGET).rows(frames))
    assert [row.mode for row in rows[3:6]] == ["TRACKING", "REJECTED", "TRACKING"]
    assert [row.frame for row in rows] == list(range(1, 21))
