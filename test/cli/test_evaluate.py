# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import json

import pytest
from small_recordings import frame_folder, record

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.evaluation.grid.running import run_cell


@pytest.fixture(scope="module")
def bags(tmp_path_factory):
    """Two recordings, which nobody changes."""
    folder = tmp_path_factory.mktemp("bags")
    for name in ("one", "two"):
        record(folder / name)
    return folder


def in_this_process(cells):
    for cell in cells:
        yield cell, run_cell(cell)


@pytest.fixture(autouse=True)
def _quick(request, monkeypatch):
    """Start no processes, but in the test that is about them."""
    if request.function is not test_a_folder_of_recordings_is_evaluated:
        name = "vehicle_pf_tracker.cli.evaluate.runner_of"
        monkeypatch.setattr(name, lambda request: in_this_process)


def evaluate(out, *words):
    return main(["evaluate", *map(str, words), "-o", str(out), "--workers", "1"])


QUICK = ["--variants", "pf,ms", "--seeds", "2", "--set", "num_particles=30"]


def test_a_folder_of_recordings_is_evaluated(bags, tmp_path, capsys):
    assert evaluate(tmp_path / "out", bags, *QUICK) == 0
    out = capsys.readouterr().out
    assert "RMSE, px" in out and "success AUC" in out
    assert f"the report is {tmp_path / 'out' / 'report.html'}" in out
    plan = json.loads((tmp_path / "out" / "evaluation.json").read_text())
    assert [entry["name"] for entry in plan["recordings"]] == ["one", "two"]
    assert [entry["label"] for entry in plan["systems"]] == ["pf", "ms"]
    assert plan["systems"][0]["parameters"]["num_particles"] == 30
    assert plan["command"][:2] == ["vehicle-pf-tracker", "evaluate"]
    cells = {str(p.relative_to(tmp_path / "out")) for p in (tmp_path / "out").glob("cells/*/*/*")}
    assert cells == {
        f"cells/{name}/{cell}"
        for name in ("one", "two")
        for cell in ("pf/seed-0", "pf/seed-1", "ms/seed-0")
    }


def test_restarts_have_columns_of_their_own(bags, tmp_path, capsys):
    out = tmp_path / "out"
    assert evaluate(out, bags, *QUICK) == 0
    assert "With restarts" not in capsys.readouterr().out
    assert "restarts" not in (out / "summary.md").read_text()
    assert evaluate(out, bags, *QUICK, "--restart", "5") == 0
    shown = capsys.readouterr().out
    assert "With restarts after failure" in shown and "robustness" in shown
    assert "With restarts after failure</h3>" in (out / "report.html").read_text()
    metrics = {line.split(",")[2] for line in (out / "summary.csv").read_text().splitlines()}
    assert {"failures", "restart_accuracy", "restart_failures", "restart_robustness"} <= metrics
    assert main(["evaluate", str(bags), "-o", str(out), "--traffic", "--restart", "5"]) == 2
    assert evaluate(out, bags, "--restart", "0") == 2


def test_an_rmse_beyond_the_limit_fails(bags, tmp_path, capsys):
    assert evaluate(tmp_path / "out", bags, *QUICK, "--max-rmse", "50") == 0
    assert evaluate(tmp_path / "out", bags, *QUICK, "--max-rmse", "0.01") == 1
    err = capsys.readouterr().err.splitlines()[-1]
    assert "larger than --max-rmse 0.01 px: pf " in err
    assert ", ms " in err


def systems(out):
    plan = json.loads((out / "evaluation.json").read_text())
    return {entry["label"]: entry for entry in plan["systems"]}


def test_parameter_sets_are_systems_of_their_own(bags, tmp_path, capsys):
    file = tmp_path / "mine.yaml"
    file.write_text("pf_tracker:\n  ros__parameters:\n    sigma: 3.0\n    queue_depth: 5\n")
    words = [bags / "one", *QUICK, "--params", file, "--params", f"pf@sure={file}"]
    words += ["--set", "ms@few:iterations=2"]
    assert evaluate(tmp_path / "out", *words, "--set", "mine:num_particles=20") == 0
    found = systems(tmp_path / "out")
    assert list(found) == ["pf", "pf@mine", "pf@sure", "ms", "ms@few"]
    assert found["pf@mine"]["parameters"]["sigma"] == 3.0
    assert found["pf@mine"]["overrides"] == {"num_particles": 20}
    assert found["pf@mine"]["parameter_set"] == "mine"
    assert found["ms@few"]["parameters"]["iterations"] == 2
    assert found["pf@sure"]["parameters"]["sigma"] == 3.0
    told = capsys.readouterr().err
    assert "ms is not run with mine" in told and "not run with sure" not in told


def test_a_baseline_that_is_not_there_is_named_and_the_rest_goes_on(bags, tmp_path, capsys):
    words = ["--variants", "ms,baseline:csrt", "--baselines-python", tmp_path / "none"]
    assert evaluate(tmp_path / "out", bags / "one", *words) == 1
    assert "baseline:csrt cannot run: there is no interpreter" in capsys.readouterr().err
    failed = tmp_path / "out" / "cells" / "one" / "baseline_csrt" / "seed-0" / "failed.json"
    assert "python3 -m venv" in json.loads(failed.read_text())["reason"]


def test_an_evaluation_in_which_nothing_runs_fails(bags, tmp_path, capsys):
    words = ["--variants", "baseline:csrt", "--baselines-python", tmp_path / "none"]
    assert evaluate(tmp_path / "out", bags / "one", *words) == 1
    assert capsys.readouterr().err.endswith("error: no system could run; the report says why\n")


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["--variants", "kalman"], 1, "no variant 'kalman'"),
        (["--variants", ","], 2, "--variants names none"),
        (["--variants", "baseline:boost"], 1, "unknown baseline 'boost'"),
        (["--variants", "baseline:csrtt"], 1, "'csrtt' (did you mean 'csrt'?); the baselines are"),
        (["--set", "sgima=2"], 1, "no parameter 'sgima' (did you mean 'sigma'?)"),
        (["--set", "seed=2"], 1, "no parameter 'seed'"),
        (["--set", "target.x=2"], 1, "no parameter 'target.x'"),
        (["--variants", "pf", "--set", "few:iterations=2"], 1, "pf is not run with few: there is"),
        (["--variants", "pf", "--set", "a:sigma=wide"], 1, "sigma must be a number"),
        (["--params", "none.yaml"], 1, "cannot read the parameter file none.yaml"),
        (["--params", "pf@a=none.yaml"], 1, "cannot read the parameter file none.yaml"),
        (["--variants", "pf", "--set", "ms@few:iterations=2"], 1, "no variant among --variants"),
        (["--set", "a:sgima=2"], 1, "apf is not run with a: there is no parameter 'sgima'"),
        (["--variants", "baseline:csrt", "--set", "a:sigma=2"], 1, "set a is for no variant"),
        (["--baseline-model", "vit=a"], 2, "--baseline-model expects BASELINE:NAME=FILE"),
        (["--seeds", "0"], 2, "'0' is not an integer >= 1"),
        (["--max-diff", "-1"], 1, "seconds >= 0"),
    ],
)
def test_mistakes_are_told_in_one_line(bags, tmp_path, capsys, words, status, said):
    assert evaluate(tmp_path / "out", bags / "one", *words) == status
    assert said in capsys.readouterr().err.splitlines()[-1]
    assert not (tmp_path / "out").exists()


def test_things_that_are_no_recordings_say_what_to_do(tmp_path, capsys):
    (tmp_path / "clip.mp4").touch()
    (tmp_path / "notes.txt").touch()
    (tmp_path / "empty").mkdir()
    frames = frame_folder(tmp_path / "frames")
    (frames / "groundtruth.csv").rename(frames / "groundtruth.old")
    (frames / "groundtruth.old").write_text("m4,5,2")
    record(tmp_path / "untrue", truths=())
    for name, said in {
        "clip.mp4": "is not a video file that can be decoded",
        "frames": "groundtruth.old looks like truth, but is in no format that is read",
        "notes.txt": "is not a video file that can be decoded",
        "empty": "has no images",
        "none": "there is no file or folder",
        "untrue": "has no truth to compare with",
    }.items():
        assert evaluate(tmp_path / "out", tmp_path / name, *QUICK) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert str(tmp_path / name) in line
        assert said in line


def test_folders_of_images_are_evaluated_as_their_imports(tmp_path):
    def scores(name, source):
        assert evaluate(tmp_path / name, source, "--variants", "ms") == 0
        return {
            path.parts[-4]: json.loads(path.read_text())["rmse_px"]
            for path in (tmp_path / name).glob("cells/*/ms/*/metrics.json")
        }

    for name in ("a", "b"):
        folder = frame_folder(tmp_path / "frames" / name)
        assert main(["import", str(folder), str(tmp_path / "bags" / name)]) == 0
    found = scores("out", tmp_path / "frames")
    assert sorted(found) == ["a", "b"]
    assert found == scores("imported", tmp_path / "bags")
    truth = folder / "groundtruth.csv"
    truth.write_text(truth.read_text().replace(",24,", ",9,"))
    assert scores("out", tmp_path / "frames")["b"] != found["b"]


def test_a_vehicle_of_several_is_chosen_by_its_number(tmp_path, capsys):
    frames = frame_folder(tmp_path / "frames")
    rows = (frames / "groundtruth.csv").read_text().splitlines()[1:]
    (frames / "groundtruth.csv").unlink()
    (frames / "gt").mkdir()
    boxes = [row.split(",")[:5] for row in rows]
    (frames / "gt" / "gt.txt").write_text(
        "\n".join(
            f"{number},{vehicle},{x},{float(y) + vehicle},{w},{h},1,1,1"
            for number, x, y, w, h in boxes
            for vehicle in (4, 7)
        )
    )
    assert evaluate(tmp_path / "out", frames, "--variants", "ms") == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("gt.txt has the truth of 2 vehicles; choose one with --id: 4, 7")
    assert evaluate(tmp_path / "out", frames, "--variants", "ms", "--id", 7) == 0
    (entry,) = json.loads((tmp_path / "out" / "evaluation.json").read_text())["recordings"]
    assert entry["identity"] == 7
    truth = (tmp_path / "out" / "recordings" / "frames" / "truth.csv").read_text().splitlines()
    assert float(truth[1].split(",")[3]) == 24 + 7 - 1  # the file counts pixels from 1
    assert evaluate(tmp_path / "two", "--traffic", frames, "--id", 7) == 2
    assert "--id does not go with --traffic" in capsys.readouterr().err


def test_recordings_of_one_name_are_told_apart(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        record(tmp_path / name / "bag")
    words = [tmp_path / "a", tmp_path / "b" / "bag", "--variants", "ms"]
    assert evaluate(tmp_path / "out", *words) == 0
    assert sorted(p.name for p in (tmp_path / "out" / "cells").iterdir()) == ["a-bag", "b-bag"]
