# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import csv
import json
import statistics

import pytest
from small_recordings import record

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.evaluation.grid.running import CellResult, run_cell

pytest.importorskip("optuna", reason="the extra [evaluation] is not installed")

QUICK = ["--variant", "pf", "--trials", "3", "--seeds", "2", "--set", "num_particles=20"]


@pytest.fixture(autouse=True)
def _in_this_process(monkeypatch):
    def runner(cells):
        for cell in cells:
            yield cell, run_cell(cell)

    monkeypatch.setattr("vehicle_pf_tracker.cli.tune.runner_of", lambda request: runner)


@pytest.fixture
def bags(tmp_path):
    record(tmp_path / "one")
    record(tmp_path / "two", count=10, truths=range(10))
    return tmp_path / "one", tmp_path / "two"


def tune(out, *words):
    return main(["tune", *map(str, words), "-o", str(out)])


def test_the_best_is_written_for_the_node_and_for_evaluate(bags, tmp_path, capsys):
    out = tmp_path / "out"
    words = [*bags, *QUICK, "--search", "sigma=2:9,likelihood.sigma_v"]
    assert tune(out, *words) == 0
    told = capsys.readouterr().out
    assert f"evaluate REC --variants pf --params {out / 'best.yaml'} -o DIR" in told
    trials = list(csv.DictReader((out / "trials.csv").open()))
    assert [trial["trial"] for trial in trials] == ["0", "1", "2"]
    assert (trials[0]["sigma"], trials[0]["likelihood.sigma_v"]) == ("8.0", "0.158")
    best = max(trials, key=lambda trial: float(trial["success_auc"]))
    first = float(trials[0]["success_auc"])
    scores = f"{first:.3f} at first, {float(best['success_auc']):.3f} in trial {best['trial']}"
    assert f"success_auc: {scores}" in told
    assert "tuned by `vehicle-pf-tracker tune` on one, two; success" in (
        out / "best.yaml"
    ).read_text().replace("\n# ", " ")
    run = tmp_path / "run"
    yaml = ["--params", str(out / "best.yaml")]
    assert main(["run", str(bags[0]), "--variant", "pf", *yaml, "-o", str(run)]) == 0
    parameters = json.loads((run / "run.json").read_text())["parameters"]
    assert parameters["sigma"] == float(best["sigma"])
    assert parameters["num_particles"] == 20


def test_the_same_search_gives_the_same_and_runs_nothing_again(bags, tmp_path):
    out = tmp_path / "out"
    assert tune(out, bags[0], *QUICK) == 0
    names = ("best.yaml", "trials.csv")
    before = {name: (out / name).read_bytes() for name in names}
    assert tune(out, bags[0], *QUICK) == 0
    assert {name: (out / name).read_bytes() for name in names} == before


def test_the_gain_is_checked_on_what_was_held_out(bags, tmp_path, capsys):
    out = tmp_path / "out"
    words = [bags[0], *QUICK, "--search", "sigma=2:9", "--held-out", bags[1]]
    assert tune(out, *words) == 0
    told = capsys.readouterr().out
    table = (out / "tuning.md").read_text().splitlines()
    assert [line.split(" | ")[0] for line in table[2:6]] == [
        "| tuned on: one", "| tuned on: mean of 1", "| held out: two", "| held out: mean of 1",
    ]  # fmt: skip
    assert table[-1].endswith(".") and table[-1] in told
    cells = out / "evaluation" / "cells" / "two"
    for label in ("pf", "pf_best"):
        scores = [
            json.loads((cells / label / f"seed-{seed}" / "metrics.json").read_text())
            for seed in (0, 1)
        ]
        mean = statistics.fmean(score["success_auc"] for score in scores)
        assert f"{mean:.3f} ± " in table[4]


def test_what_is_tuned_on_cannot_be_held_out(bags, tmp_path, capsys):
    (tmp_path / "copy").mkdir()
    copy = record(tmp_path / "copy" / "one")
    assert tune(tmp_path / "out", bags[0], *QUICK, "--held-out", copy) == 1
    assert "is both held out and tuned on" in capsys.readouterr().err


def test_a_search_that_no_trial_ends_well_is_told(bags, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(
        "vehicle_pf_tracker.cli.tune.runner_of",
        lambda request: lambda cells: ((cell, CellResult(reason="so")) for cell in cells),
    )
    assert tune(tmp_path / "out", bags[0], *QUICK) == 1
    assert "no trial could be scored" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["--search", "sgima"], 1, "did you mean 'sigma'"),
        (["--variant", "kalman"], 1, "no variant 'kalman'"),
        (["--objective", "beauty"], 2, "argument --objective"),
        (["--set", "target.x=3"], 1, "no parameter 'target.x'"),
        (["--trials", "0"], 2, "not an integer >= 1"),
        (["--params", "none.yaml"], 1, "cannot read the parameter file none.yaml"),
    ],
)
def test_mistakes_are_told_in_one_line(bags, tmp_path, capsys, words, status, said):
    assert tune(tmp_path / "out", bags[0], *QUICK, *words) == status
    assert said in capsys.readouterr().err.splitlines()[-1]
    assert not (tmp_path / "out").exists()
