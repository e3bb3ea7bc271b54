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

import csv
import json

import pytest
from small_recordings import record

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.evaluation.grid.running import run_cell

pytest.importorskip("optuna", reason="the extra [evaluation] is not installed")

QUICK = ["--variant", "pf", "--trials", "3", "--seeds", "2", "--set", "num_particles=20"]


@pytest.fixture(autouse=True)
def _in_this_process(monkeypatch):
    def runner(cells):
        for cell in cells:
            yield cell, run_cell(cell)

    monkeypatch.setattr("vehicle_pf_tracker.cli.tune.on_this_machine", lambda workers: runner)


@pytest.fixture
def bags(tmp_path):
    record(tmp_path / "one")
    record(tmp_path / "two", count=10, truths=range(10))
    return tmp_path / "one", tmp_path / "two"


def tune(out, *words):
    return main(["tune", *map(str, words), "-o", str(out)])


def test_the_best_is_written_for_the_node_and_compared_on_what_was_held_out(bags, tmp_path, capsys):
    out = tmp_path / "out"
    words = [bags[0], *QUICK, "--search", "sigma=2:9,likelihood.sigma_v", "--held-out", bags[1]]
    assert tune(out, *words) == 0
    told = capsys.readouterr().out
    assert f"the parameters are {out / 'best.yaml'}" in told
    trials = list(csv.DictReader((out / "trials.csv").open()))
    assert [trial["trial"] for trial in trials] == ["0", "1", "2"]
    assert (trials[0]["sigma"], trials[0]["likelihood.sigma_v"]) == ("8.0", "0.158")
    document = json.loads((out / "tuning.json").read_text())
    best = max(trials, key=lambda trial: float(trial["success_auc"]))
    assert document["best"]["sigma"] == float(best["sigma"])
    assert document["searched"][0] == "sigma: 2 to 9, logarithmic"
    parts = {(line["part"], line["recording"]) for line in document["comparison"]}
    assert parts == {
        ("tuned on", "one"),
        ("tuned on", "mean of 1"),
        ("held out", "two"),
        ("held out", "mean of 1"),
    }
    assert "tuned on: one | success_auc" in (out / "tuning.md").read_text()
    assert (out / "evaluation" / "report.html").is_file()
    run = tmp_path / "run"
    yaml = ["--params", str(out / "best.yaml")]
    assert main(["run", str(bags[0]), "--variant", "pf", *yaml, "-o", str(run)]) == 0
    parameters = json.loads((run / "run.json").read_text())["parameters"]
    assert parameters["sigma"] == float(best["sigma"])
    assert parameters["num_particles"] == 20


def test_the_same_search_gives_the_same_and_runs_nothing_again(bags, tmp_path):
    out = tmp_path / "out"
    assert tune(out, bags[0], *QUICK) == 0
    names = ("best.yaml", "trials.csv", "runs.jsonl", "tuning.json")
    before = {name: (out / name).read_bytes() for name in names}
    assert tune(out, bags[0], *QUICK) == 0
    assert {name: (out / name).read_bytes() for name in names} == before


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


def test_what_is_tuned_on_cannot_be_held_out(bags, tmp_path, capsys):
    (tmp_path / "copy").mkdir()
    copy = record(tmp_path / "copy" / "one")
    assert tune(tmp_path / "out", bags[0], *QUICK, "--held-out", copy) == 1
    assert "is both held out and tuned on" in capsys.readouterr().err
