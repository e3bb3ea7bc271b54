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

import math

import pytest
from scoring_samples import NONE, PARTIAL, PERIOD_NS, TOTAL, row, run_of, scored

from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.occlusions import (
    count_failures,
    first_failure,
    is_failure,
    restart_index,
    score_restarts,
)
from vehicle_pf_tracker.evaluation.scores import FrameScore
from vehicle_pf_tracker.offline.estimates import EstimateRow

# Boxes are 24 px wide: at 12 px a third of the union is shared, from 24 px on nothing.


def frames_of(*parts):
    return run_of(*parts).frames


@pytest.mark.parametrize(("error", "fails"), [(0, False), (23.9, False), (24.0, True), (99, True)])
def test_a_failure_shares_nothing_with_the_truth(error, fails):
    assert is_failure(scored(1, error)) is fails


def test_what_nobody_can_see_is_no_failure():
    assert not is_failure(scored(1, 99, TOTAL))
    assert is_failure(scored(1, 99, PARTIAL))
    assert not is_failure(FrameScore(row(1, 500.0), None))
    assert not is_failure(FrameScore(EstimateRow.without(1, PERIOD_NS, "WAITING"), None))


def test_failures_are_counted_by_stretches():
    assert count_failures(frames_of((9, 0, NONE))) == 0
    assert count_failures(frames_of((3, 0, NONE), (3, 50, NONE), (2, 0, NONE), (1, 50, NONE))) == 2
    # Lost before an occlusion and still lost behind it: once.
    assert count_failures(frames_of((2, 50, NONE), (5, 50, TOTAL), (2, 50, NONE))) == 1
    assert measure(run_of((3, 0, NONE), (3, 50, NONE))).failures == 1


def test_the_first_failure_from_a_frame_on():
    frames = frames_of((3, 0, NONE), (2, 50, NONE), (3, 0, NONE), (1, 50, NONE))
    assert first_failure(frames) == 3
    assert first_failure(frames, 5) == 8
    assert first_failure(frames[:3]) is None


def test_a_restart_waits_five_frames_and_for_a_full_view():
    assert restart_index(frames_of((20, 0, NONE)), 3) == 8
    frames = frames_of((6, 50, NONE), (4, 50, TOTAL), (2, 50, PARTIAL), (9, 0, NONE))
    assert restart_index(frames, 3) == 12
    assert restart_index(frames[:12], 3) is None


def test_a_run_with_a_restart_by_hand():
    # 20 good frames, failure in frame index 20, started anew at 25, good until the end at 45.
    frames = frames_of((20, 0, NONE), (5, 90, NONE), (20, 12, NONE))
    score = score_restarts(frames, [0, 25])
    assert (score.failures, score.frames) == (1, 40)
    assert score.accuracy == pytest.approx((10 * 1 + 10 / 3) / 20)
    assert score.robustness == pytest.approx(math.exp(-30 / 40))


def test_hidden_frames_say_nothing_about_accuracy():
    score = score_restarts(frames_of((10, 0, NONE), (10, 90, TOTAL), (5, 0, NONE)), [0])
    assert (score.failures, score.accuracy) == (0, 1)


def test_a_run_that_fails_at_once_has_no_accuracy():
    score = score_restarts(frames_of((9, 90, NONE)), [0])
    assert (score.failures, score.frames, score.accuracy, score.robustness) == (1, 0, None, None)
