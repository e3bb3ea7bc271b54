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

import pytest
from scoring_samples import NONE, PARTIAL, PERIOD_NS, TOTAL, row, run_of, scored

from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.occlusions import count_failures, is_failure
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
