# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from types import SimpleNamespace

import pytest

pytest.importorskip("optuna", reason="the extra [evaluation] is not installed")

from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.grid.running import CellResult
from vehicle_pf_tracker.evaluation.search_space import search_space
from vehicle_pf_tracker.evaluation.statistics import mean_of_means
from vehicle_pf_tracker.evaluation.systems import System
from vehicle_pf_tracker.evaluation.tuning import SearchTask, check_gain, open_study, search
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


def what(*words, objective="rmse_px", seeds=(100, 101)):
    variant = find_variant("pf")
    values = {n: v for n, v in to_mapping(variant.parameters()).items() if n != "seed"}
    base = System.of_variant("pf", tuple(values.items()))
    space = search_space(variant, values, words or ["sigma"])
    return SearchTask(base, space, SOURCES, seeds, objective, 0.01)


def silent(done, total):
    pass


@pytest.fixture
def journal(tmp_path):
    return tmp_path / "study.log"


def find(journal, count, runner=None, on_progress=silent, task=None):
    task = task or what()
    return search(task, count, open_study(task, journal), runner or FakeRunner(), on_progress)


def found(trials):
    return [(trial.params, trial.value) for trial in trials]


def test_the_search_begins_with_the_base_and_comes_close_to_the_best(journal):
    trials = find(journal, 40)
    assert len(trials) == 40
    assert trials[0].params == {"sigma": 8.0}
    assert trials[0].value == pytest.approx(5.0 + 1.005)
    best = open_study(what(), journal).best_trial
    assert best.value == min(trial.value for trial in trials)
    assert best.params["sigma"] == pytest.approx(BEST_SIGMA, abs=0.3)


def test_a_base_outside_of_a_given_range_is_tried_first_nevertheless(journal):
    first, *others = find(journal, 8, task=what("sigma=2:5"))
    assert first.params == {"sigma": 8.0}
    assert all(2 <= trial.params["sigma"] <= 5 for trial in others)


def test_the_same_search_gives_the_same_trials_and_nothing_is_run_twice(journal, tmp_path):
    first, second = FakeRunner(), FakeRunner()
    trials = find(journal, 14, first)
    assert len(first.asked) == len(set(first.asked)) == 14 * 4
    assert found(find(journal, 14, second)) == found(trials)
    assert second.asked == []
    assert found(find(tmp_path / "other.log", 14)) == found(trials)


def test_more_trials_go_on_where_fewer_ended(journal):
    few, runner = find(journal, 9), FakeRunner()
    assert found(find(journal, 16, runner)[:9]) == found(few)
    assert len(runner.asked) == 7 * 4


@pytest.mark.parametrize(
    "other", [{"objective": "success_auc"}, {"seeds": (100,)}, {"words": ["sigma=2:9"]}]
)
def test_trials_of_another_search_do_not_count(journal, other):
    find(journal, 3)
    runner = FakeRunner()
    find(journal, 3, runner, task=what(*other.pop("words", ()), **other))
    assert runner.asked


class InterruptedHereError(Exception):
    pass


def test_an_interrupted_search_goes_on_with_the_batch_that_was_under_way(journal):
    def interrupt(done, total):
        if done == 30:
            raise InterruptedHereError

    with pytest.raises(InterruptedHereError):
        find(journal, 12, on_progress=interrupt)
    runner = FakeRunner()
    trials = find(journal, 12, runner)
    assert len(trials) == 12 and all(trial.value is not None for trial in trials)
    assert len(runner.asked) == 6 * 4


def test_trials_that_cannot_run_have_no_score_and_are_never_best(journal):
    trials = find(journal, 20, FakeRunner(fail_above=4.0))
    assert len(trials) == 20 and trials[0].value is None
    assert open_study(what(), journal).best_trial.params["sigma"] <= 4.0


def test_the_mean_is_over_recordings_not_runs():
    assert mean_of_means({"a": [1.0], "b": [2.0, 4.0]}) == 2.0
    assert mean_of_means({"a": [1.0], "b": [2.0, None]}) is None
    assert mean_of_means({}) is None


class Compared:
    """Stands for an evaluation of two systems on two recordings, by the scores of their runs."""

    folder = SimpleNamespace(
        systems=(SimpleNamespace(label="pf"), SimpleNamespace(label="pf@best")),
        recordings=SOURCES,
    )

    def __init__(self, metric, scores):
        self.metric, self.scores = metric, scores

    def of(self, recording, system):
        found = self.scores[recording][system == "pf@best"]
        return [SimpleNamespace(metrics=SimpleNamespace(**{self.metric: one})) for one in found]


UP, DOWN = "success_auc", "rmse_px"


@pytest.mark.parametrize(
    ("metric", "tuned", "other", "said"),
    [
        (UP, ([0.5, 0.6], [0.7, 0.8]), ([0.5, 0.6], [0.6, 0.7]), "holds on the recordings held "
         "out: 0.100 there, 0.200 where it was tuned."),
        (UP, ([0.5, 0.6], [0.7, 0.8]), ([0.5, 0.6], [0.4, 0.5]), "over-fitted"),
        (UP, ([0.5, 0.6], [0.7, 0.8]), ([0.5, 0.6], [0.4, 0.8]), "within the spread"),
        (UP, ([0.5], [0.5]), ([0.5], [0.9]), "no better than those before"),
        (UP, ([0.5], [0.7]), ([0.5], [0.6]), "The gain holds"),
        (UP, ([0.5], [0.7]), ([0.5], [None]), "does not hold"),
        (DOWN, ([20.0], [10.0]), ([20.0], [12.0]), "8.000 there, 10.000 where"),
        (DOWN, ([20.0], [30.0]), ([20.0], [12.0]), "no better than those before"),
    ],
)  # fmt: skip
def test_the_verdict_says_whether_the_gain_holds(metric, tuned, other, said):
    rows, verdict = check_gain(Compared(metric, {"a": tuned, "b": other}), ["b"], metric)
    assert said in verdict
    parts = ["tuned on: a", "tuned on: mean of 1", "held out: b", "held out: mean of 1"]
    assert [row[0] for row in rows] == parts


def test_the_table_of_the_gain_shows_spread_and_change():
    scores = {"a": ([1.0, 3.0], [2.0, 6.0]), "b": ([1.0, 1.0], [0.5, 0.5])}
    rows, _ = check_gain(Compared(DOWN, scores), ["b"], DOWN)
    assert rows[0] == ["tuned on: a", "2.000 ± 1.414", "4.000 ± 2.828", "+2.000 ± 1.414"]
    assert rows[2] == ["held out: b", "1.000 ± 0.000", "0.500 ± 0.000", "-0.500 ± 0.000"]
