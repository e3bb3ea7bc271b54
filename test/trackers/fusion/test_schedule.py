# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Costly tasks: both in a disturbed frame, in turns in undisturbed ones."""

import pytest

from vehicle_pf_tracker.trackers.fusion.schedule import Tasks

BOTH, SIZE_ONLY, FILTER_ONLY = Tasks(True, True), Tasks(True, False), Tasks(False, True)


def test_undisturbed_frames_take_turns():
    tasks, seen = Tasks(), []
    for frames in range(11, 17):
        tasks = tasks.next(frames, 0.95, was_visible=True)
        seen.append(tasks)
    assert seen == [SIZE_ONLY, FILTER_ONLY] * 3


@pytest.mark.parametrize("before", [BOTH, SIZE_ONLY, FILTER_ONLY])
@pytest.mark.parametrize(
    ("frames", "level", "was_visible"),
    [(10, 0.95, True), (11, 0.9, True), (11, 0.95, False), (11, 0.0, True)],
)
def test_any_doubt_does_both(before, frames, level, was_visible):
    assert before.next(frames, level, was_visible=was_visible) == BOTH


def test_a_frame_that_did_not_train_is_followed_by_one_that_does():
    assert SIZE_ONLY.next(50, 0.95, was_visible=True) == FILTER_ONLY
    assert FILTER_ONLY.next(50, 0.95, was_visible=True) == SIZE_ONLY
