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

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.grid.cells import VariantSystem
from vehicle_pf_tracker.evaluation.grid.running import CellResult
from vehicle_pf_tracker.evaluation.result_store import ResultStore
from vehicle_pf_tracker.evaluation.search_space import OBJECTIVES, search_space
from vehicle_pf_tracker.evaluation.statistics import mean_of_means
from vehicle_pf_tracker.evaluation.tuning import (
    SearchTask,
    Trial,
    best_of,
    search,
    to_csv,
)
from vehicle_pf_tracker.parameters.table import to_mapping
from vehicle_pf_tracker.trackers.registry import find_variant

SOURCES = [Source(name, name, "/image", 1, 1, 1, name) for name in ("a", "b")]
BEST_SIGMA = 3.0


class Scored:
    """Stands for the metrics of a run: the further sigma is from the best, the worse."""

    def __init__(self, cell):
        off = abs(dict(cell.system.parameters)["sigma"] - BEST_SIGMA)
        self.rmse_px = off + 0.01 * cell.seed
        self.success_auc = -self.rmse_px


class FakeRunner:
    """Runs nothing, and counts what it was asked for."""

    def __init__(self, fail_above=None):
        self.asked = []
        self.fail_above = fail_above

    def __call__(self, cells):
        for cell in cells:
            self.asked.append(cell)
            sigma = dict(cell.system.parameters)["sigma"]
            if self.fail_above is not None and sigma > self.fail_above:
                yield cell, CellResult(reason="too wide")
            else:
                yield cell, CellResult(metrics=Scored(cell))


def what(objective="rmse_px", **more):
    variant = find_variant("pf")
    values = {n: v for n, v in to_mapping(variant.parameters()).items() if n != "seed"}
    base = VariantSystem("pf", "pf", "", (), tuple(values.items()))
    space = search_space(variant, values, ["sigma"])
    return SearchTask(base, space, SOURCES, (100, 101), OBJECTIVES[objective], 0.01, **more)


def silent(done, total):
    pass


@pytest.fixture
def store(tmp_path):
    return ResultStore(tmp_path / "runs.jsonl")


def test_the_search_begins_with_the_base_and_comes_close_to_the_best(store):
    trials = search(what(), 40, store, FakeRunner(), silent)
    assert [trial.number for trial in trials] == list(range(40))
    assert trials[0].values == {"sigma": 8.0}
    assert trials[0].score == pytest.approx(5.0 + 1.005)
    best = best_of(trials, OBJECTIVES["rmse_px"])
    assert best.values["sigma"] == pytest.approx(BEST_SIGMA, abs=0.3)


def test_a_seed_gives_the_same_trials_again_and_nothing_is_run_twice(store, tmp_path):
    first, second, other = FakeRunner(), FakeRunner(), FakeRunner()
    trials = search(what(), 14, store, first, silent)
    assert len(first.asked) == len(set(first.asked)) == 14 * 4
    assert search(what(), 14, ResultStore(tmp_path / "runs.jsonl"), second, silent) == trials
    assert second.asked == []
    elsewhere = ResultStore(tmp_path / "other.jsonl")
    assert search(what(sampler_seed=1), 14, elsewhere, other, silent) != trials


def test_more_trials_go_on_where_fewer_ended(store, tmp_path):
    few = search(what(), 9, store, FakeRunner(), silent)
    runner = FakeRunner()
    more = search(what(), 16, store, runner, silent)
    assert more[:9] == few
    assert len(runner.asked) == 7 * 4
    whole = search(what(), 16, ResultStore(tmp_path / "whole.jsonl"), FakeRunner(), silent)
    assert more == whole


class InterruptedHereError(Exception):
    pass


def test_an_interrupted_search_goes_on_with_the_next_run(store, tmp_path):
    def interrupt(done, total):
        if done == 30:
            raise InterruptedHereError

    with pytest.raises(InterruptedHereError):
        search(what(), 12, store, FakeRunner(), interrupt)
    runner = FakeRunner()
    trials = search(what(), 12, ResultStore(tmp_path / "runs.jsonl"), runner, silent)
    assert len(runner.asked) == 12 * 4 - 30
    whole = ResultStore(tmp_path / "whole.jsonl")
    assert search(what(), 12, whole, FakeRunner(), silent) == trials


def test_trials_that_cannot_run_have_no_score_and_are_never_best(store):
    trials = search(what(), 20, store, FakeRunner(fail_above=4.0), silent)
    assert trials[0].score is None
    assert best_of(trials, OBJECTIVES["rmse_px"]).values["sigma"] <= 4.0
    with pytest.raises(InputError, match="no trial could be scored"):
        best_of(trials[:1], OBJECTIVES["rmse_px"])


def test_of_equals_the_first_is_best():
    trials = [Trial(0, {}, 2.0), Trial(1, {}, 1.0), Trial(2, {}, 1.0)]
    assert best_of(trials, OBJECTIVES["rmse_px"]).number == 1
    assert best_of(trials, OBJECTIVES["success_auc"]).number == 0


def test_the_mean_is_over_recordings_not_runs():
    assert mean_of_means({"a": [1.0], "b": [2.0, 4.0]}) == 2.0
    assert mean_of_means({"a": [1.0], "b": [2.0, None]}) is None
    assert mean_of_means({}) is None


def test_all_trials_are_in_the_table():
    trials = [Trial(0, {"sigma": 8.0}, 0.1), Trial(1, {"sigma": 2.5}, None)]
    text = to_csv(trials, OBJECTIVES["success_auc"])
    assert text == "trial,success_auc,sigma\n0,0.1,8.0\n1,,2.5\n"
