# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`evaluate --traffic`."""

import sys

import pytest

from laboratory.scenes import make_traffic_scene
from laboratory.scenes.mot_folder import write_mot_folder
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.evaluation import baseline_process as client

WORKER = """
import json, sys
print(json.dumps({"trackers": "0", "trackeval": "0"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    names = ["HOTA", "DetA", "AssA", "LocA", "IDF1", "MOTA", "IDSW", "Frag", "FP", "FN"]
    answer = {"tracks": [], "seconds": 0.5} if "track" in request else dict.fromkeys(names, 1.5)
    print(json.dumps(answer), flush=True)
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("mot") / "pair"
    scene = make_traffic_scene("traffic-pair", settings={"frames": 4})
    write_mot_folder(scene, path, 0)
    return path


def evaluate(*words):
    return main(["evaluate", *map(str, words)])


def test_a_comparison_is_written_and_shown(folder, tmp_path, monkeypatch, capsys):
    script = tmp_path / "worker.py"
    script.write_text(WORKER)
    monkeypatch.setattr(client, "WORKER", script)
    out = tmp_path / "out"
    words = ["--baselines-python", sys.executable, "--detections", "good,motion"]
    words += ["--set", "lost_after=1.5"]
    assert evaluate("--traffic", folder, "-o", out, *words) == 0
    shown = capsys.readouterr().out
    assert "pair, good" in shown
    assert "pair, motion" in shown
    assert "traffic.md" in shown
    assert {path.name for path in out.iterdir()} == {
        "traffic.md", "traffic.csv", "traffic.json"
    }  # fmt: skip
    assert "| ocsort-low | 1.5 | 1.5 |" in (out / "traffic.md").read_text()
    assert '"lost_after=1.5"' in (out / "traffic.json").read_text()


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        (["--traffic", "{folder}", "--figures", "pdf"], 2, "--figures does not go with --traffic"),
        (["{folder}", "--detections", "good"], 2, "--detections does not go without --traffic"),
        (["--traffic", "{folder}", "--detections", "god"], 1, "'god' is not a file of det/ (did"),
        (["--traffic", "{folder}", "--set", "lost=1"], 1, "lost"),
        (["--traffic", "{folder}/img1"], 1, "is not a MOTChallenge folder: it has no seqinfo.ini"),
    ],
)
def test_what_does_not_fit_is_told(folder, tmp_path, capsys, words, status, sentence):
    filled = [word.format(folder=folder) for word in words]
    assert evaluate(*filled, "-o", tmp_path / "out") == status
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
