# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Followers take turns, and are told apart by what they cost and where they are."""

import pytest

from benchmarks.bench.effort import QUICK
from benchmarks.bench.material import drive
from benchmarks.bench.steps import measure
from benchmarks.bench.turns import TURN_FRAMES, Own, follow


class Stub:
    def __init__(self, name, log, seconds):
        self.name, self.log, self.seconds = name, log, seconds

    def start(self, frame, box, seed):
        self.log.append((self.name, "start", seed))
        self.centre = box.centre

    def step(self, frame):
        self.log.append((self.name, "step", None))
        return self.seconds


def test_all_follow_the_same_frames_block_by_block():
    log = []
    times, shares = follow(
        {"a": Stub("a", log, 1.0), "b": Stub("b", log, 2.0)}, [7], 2 * TURN_FRAMES + 5
    )
    assert log[:2] == [("a", "start", 7), ("b", "start", 7)]
    steps = [name for name, what, _ in log if what == "step"]
    assert steps == [*"a" * TURN_FRAMES, *"b" * TURN_FRAMES, *"b" * TURN_FRAMES, *"a" * TURN_FRAMES]
    assert times == {"a": [1.0, 1.0], "b": [2.0, 2.0]}
    # They stay at the first box; the vehicle moves 5 px a frame, half its diagonal is 25 px.
    assert shares["a"] == pytest.approx(4 / (2 * TURN_FRAMES))


def test_the_cost_of_several_trackers_is_that_of_one():
    own = Own("pf", {"num_particles": 20}, count=3)
    frames, boxes = drive()
    own.start(frames[0], boxes[0], seed=1)
    assert own.step(frames[1]) > 0
    assert abs(own.centre[0] - boxes[1].centre[0]) < 20


def test_nothing_is_run_that_nobody_wants():
    assert measure(lambda name: False, QUICK, None) == ([], {})
