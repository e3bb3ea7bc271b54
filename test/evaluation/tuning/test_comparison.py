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

pytest.importorskip("optuna", reason="the extra [evaluation] is not installed")

from vehicle_pf_tracker.evaluation.search_space import OBJECTIVES
from vehicle_pf_tracker.evaluation.tuning import (
    HELD_OUT,
    TUNED,
    ComparedMetric,
    texts,
    verdict,
)

UP, DOWN = OBJECTIVES["success_auc"], OBJECTIVES["rmse_px"]


def lines(metric, tuned, held_out):
    found = [
        ComparedMetric(TUNED, "a", metric, 1.0, 1.0),
        ComparedMetric(TUNED, "mean of 1", metric, *tuned),
    ]
    return found + ([ComparedMetric(HELD_OUT, "mean of 2", metric, *held_out)] if held_out else [])


@pytest.mark.parametrize(
    ("objective", "tuned", "held_out", "said"),
    [
        (UP, (0.5, 0.7), (0.5, 0.6), "50% of the gain is left"),
        (UP, (0.5, 0.7), (0.5, 0.4), "over-fitted"),
        (UP, (0.5, 0.7), (0.5, 0.8), "The gain holds on the recordings held out"),
        (UP, (0.5, 0.5), (0.5, 0.9), "no better than those before"),
        (UP, (0.5, 0.7), None, "Without --held-out"),
        (UP, (0.5, 0.7), (0.5, None), "over-fitted"),
        (DOWN, (20.0, 10.0), (20.0, 12.0), "80% of the gain is left"),
        (DOWN, (20.0, 30.0), (20.0, 12.0), "no better than those before"),
    ],
)
def test_the_verdict_says_whether_the_gain_holds(objective, tuned, held_out, said):
    assert said in verdict(lines(objective.metric, tuned, held_out), objective)


def test_the_table_shows_spread_and_change():
    line = ComparedMetric(TUNED, "road", "rmse_px", 12.0, 10.5, 1.0, 0.25)
    expected = ["tuned on: road", "rmse_px", "12.000 ± 1.000", "10.500 ± 0.250", "-1.500"]
    assert texts([line])[1] == [expected]
