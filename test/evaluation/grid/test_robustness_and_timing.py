# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

import json

import pytest
from drive import stamp_of
from grid_samples import HIDDEN, here, make_plan, silent, system, write_recordings

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.grid.cells import (
    BaselineSystem,
    Start,
    shifted_starts,
    start_frames,
)
from vehicle_pf_tracker.evaluation.grid.plan import Robustness
from vehicle_pf_tracker.evaluation.grid.running import complete
from vehicle_pf_tracker.evaluation.grid.tracking import WARM_UP, time_systems
from vehicle_pf_tracker.evaluation.occlusions import follow_restarted
from vehicle_pf_tracker.offline.estimates import WAITING, EstimateRow, read_estimates

TRUE = Box(100, 50, 20, 10)


def truths(count, hidden=()):
    kinds = [Occlusion.TOTAL if i in hidden else Occlusion.NONE for i in range(count)]
    return tuple(Truth(stamp_of(i), TRUE, kind) for i, kind in enumerate(kinds))


def test_the_shifted_starts_are_those_of_otb():
    boxes = {start.name: start.on(truths(3)).box for start in shifted_starts()}
    assert len(boxes) == 12
    assert boxes["left"] == Box(98, 50, 20, 10)
    assert boxes["right_down"] == Box(102, 51, 20, 10)
    assert boxes["scale_0.8"] == Box(102, 51, 16, 8)
    assert boxes["scale_1.2"] == Box(98, 49, 24, 12)


def test_start_frames_are_spread_and_never_hidden():
    found = start_frames(truths(101, hidden=range(35, 45)), 2)
    assert [start.stamp_ns for start in found] == [stamp_of(45), stamp_of(80)]
    assert start_frames(truths(101), 0) == []
    assert len(start_frames(truths(3), 20)) == 2  # as many as there are


class Scripted:
    """Is on its target but for the frames named, whatever it was started on."""

    def __init__(self, misses, made, truth):
        self.misses = misses
        made.append(truth.stamp_ns)

    def rows(self, frames):
        for number, (stamp, _) in enumerate(frames, start=1):
            index = (stamp - stamp_of(0)) // (stamp_of(1) - stamp_of(0))
            x = 400.0 if index in self.misses else 110.0
            yield EstimateRow(number, stamp, x, 55.0, 20.0, 10.0, "TRACKING", None, None, None)


class FixedFootage:
    def __init__(self, truth, blank_start=0):
        self.truth = truth[blank_start:]
        self.stamps = [one.stamp_ns for one in truth]

    def frames(self):
        return iter([(stamp, None) for stamp in self.stamps])


def test_a_run_is_started_anew_five_frames_after_it_failed():
    made = []
    footage = FixedFootage(truths(60))
    rows, summary = follow_restarted(footage, lambda t: Scripted({20, 40}, made, t), 0.01)
    assert made == [stamp_of(0), stamp_of(25), stamp_of(45)]
    assert [row.frame for row in rows] == list(range(1, 61))
    assert [row.frame for row in rows if row.mode == WAITING] == [*range(22, 26), *range(42, 46)]
    assert summary["failures"] == 2
    assert summary["start_frames"] == [1, 26, 46]
    assert summary["accuracy"] == pytest.approx(1.0)


def test_a_hidden_vehicle_is_no_failure_and_nothing_starts_on_it():
    made = []
    footage = FixedFootage(truths(40, hidden=range(10, 30)))
    rows, summary = follow_restarted(footage, lambda t: Scripted({8, 15}, made, t), 0.01)
    assert made == [stamp_of(0), stamp_of(30)]
    assert summary["failures"] == 1
    assert len(rows) == 40


def test_nothing_starts_before_there_is_truth():
    made = []
    rows, summary = follow_restarted(
        FixedFootage(truths(12), 4), lambda t: Scripted((), made, t), 0.01
    )
    assert made == [stamp_of(4)]
    assert [row.mode for row in rows[:5]] == [WAITING] * 4 + ["TRACKING"]
    assert summary["start_frames"] == [5]


@pytest.fixture
def recordings(tmp_path):
    return write_recordings(tmp_path / "recordings")


def test_robustness_runs_have_folders_of_their_own(recordings, tmp_path):
    out = tmp_path / "out"
    robustness = Robustness(shifted_starts=True, start_frames=1, restarts=True)
    plan = make_plan(recordings, [system("pf"), system("ms")], robustness=robustness)
    complete(plan, out, here, silent)
    for name in HIDDEN:
        below = {p.name for p in (out / "robustness/shifted_starts" / name / "pf/seed-0").iterdir()}
        assert below == {start.name for start in shifted_starts()}
        assert not (out / "robustness/shifted_starts" / name / "pf/seed-1").exists()
        (later,) = (out / "robustness/start_frames" / name / "ms/seed-0").iterdir()
        rows = read_estimates(later / "estimates.csv")
        assert [row.mode == WAITING for row in rows] == [True] * 18 + [False] * 6
        for seed in (0, 1):
            path = out / "robustness/restarts" / name / f"pf/seed-{seed}" / "restarts.json"
            assert json.loads(path.read_text())["start_frames"][0] == 1
    assert complete(plan, out, here, silent) == 0


def test_what_is_not_asked_for_any_more_goes(recordings, tmp_path):
    for robustness in (Robustness(start_frames=2), Robustness(start_frames=1)):
        plan = make_plan(recordings[:1], [system("ms")], robustness=robustness)
        complete(plan, tmp_path, here, silent)
    assert len(list((tmp_path / "robustness").rglob("metrics.json"))) == 1
    assert len(list((tmp_path / "cells").rglob("metrics.json"))) == 1


def test_a_start_without_a_place_is_the_first_truth_as_it_is():
    assert Start().on(truths(2)) is not None
    assert Start().on(truths(2)).box is TRUE


def test_the_speed_of_all_that_can_run_is_measured(recordings, tmp_path):
    systems = [system("pf"), system("ms"), BaselineSystem("csrt", str(tmp_path / "none"))]
    told = []
    time_systems(make_plan(recordings, systems), tmp_path, 10, told.append)
    cells = json.loads((tmp_path / "timings.json").read_text())["cells"]
    assert len(cells) == 6
    for cell in cells:
        if cell["system"] == "baseline:csrt":
            assert cell["steps"] == 0
            assert cell["step_ms_p50"] is None
        else:
            assert cell["steps"] == 10 - 1 - WARM_UP
            assert 0 < cell["step_ms_p50"] <= cell["step_ms_p95"]
    assert [progress.running for progress in told] == [("bridge",), ("free",)]
