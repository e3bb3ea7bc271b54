# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import csv
import json
import sys
from pathlib import Path

import pytest
from small_recordings import frame_folder, record

from laboratory.__main__ import main
from laboratory.stress import STRESS_KINDS
from vehicle_pf_tracker.evaluation.systems import BASELINE_PREFIX
from vehicle_pf_tracker.image.patches.side_network import side_network

PAGE = Path(__file__).parents[2] / "laboratory" / "notes" / "stress.md"
BASE = ["--variants", "ms", "--workers", "1"]


def evaluate(out, *words):
    return main(["stress", *map(str, words), *BASE, "-o", str(out)])


@pytest.fixture
def footage(tmp_path):
    """A recording and a frame folder, of thirty frames each."""
    record(tmp_path / "footage" / "recorded", count=30, truths=range(30))
    frame_folder(tmp_path / "footage" / "folder", count=30)
    return tmp_path / "footage"


def test_a_battery_is_run_and_resumed(footage, tmp_path, capsys):
    out = tmp_path / "out"
    words = [footage, "--kinds", "plain,mirrored,jpeg"]
    assert evaluate(out, *words) == 0
    told = capsys.readouterr()
    assert "8 cases of 2 sequences" in told.err
    assert f"the report is {out / 'stress.md'}" in told.out
    scores = (out / "scores.jsonl").read_text()
    assert len(scores.splitlines()) == 8
    document = json.loads((out / "stress.json").read_text())
    assert {entry["sequence"] for entry in document["results"]} == {"recorded", "folder"}
    assert {entry["kind"] for entry in document["results"]} == {"plain", "mirrored", "jpeg"}
    with (out / "stress.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    (plain,) = [r for r in rows if (r["name"], r["measure"]) == ("plain", "on_target")]
    assert plain["count"] == "2"
    assert "## Cameras" in (out / "stress.md").read_text()
    before = (out / "stress.md").read_bytes()
    assert evaluate(out, *words) == 0
    assert (out / "scores.jsonl").read_text() == scores
    assert (out / "stress.md").read_bytes() == before


@pytest.mark.slow
def test_baselines_are_run_too(footage, tmp_path):
    words = ["--kinds", "mirrored,plain", "--baselines-python", sys.executable]
    args = ["stress", str(footage), *words, "--variants", f"{BASELINE_PREFIX}mil", "--workers", "1"]
    assert main([*args, "-o", str(tmp_path / "out")]) == 0
    results = json.loads((tmp_path / "out" / "stress.json").read_text())["results"]
    assert [entry["system"] for entry in results] == [f"{BASELINE_PREFIX}mil"] * 4
    assert min(entry["mean_iou"] for entry in results) > 0.2
    assert {entry["fault"] for entry in results} == {""}


def test_an_unknown_kind_is_named(footage, tmp_path, capsys):
    assert evaluate(tmp_path / "out", footage, "--battery", "full", "--kinds", "rain") == 1
    assert "there is no kind 'rain'" in capsys.readouterr().err


def test_the_page_lists_every_kind():
    text = PAGE.read_text()
    for kind in STRESS_KINDS.values():
        assert f"| `{kind.name}` | {kind.group} | {kind.summary} |" in text


def estimates_of(out):
    """Digest of the estimates of the one run."""
    (line,) = (out / "scores.jsonl").read_text().splitlines()
    return json.loads(line)["result"]["estimates"]


def test_fusion_is_run_with_another_network(footage, tmp_path):
    """One that sees each side a tenth of the box farther out, and is believed."""
    words = [
        "stress",
        str(footage / "folder"),
        "--kinds",
        "plain",
        "--variants",
        "fusion",
        "--seeds",
        "1",
    ]
    own = side_network()
    file = tmp_path / "other.npz"
    own._replace(last=own.last + 0.1, noise=own.noise / 10).write(file)
    same = tmp_path / "same.npz"
    own.write(same)
    digests = []
    for name, more in (
        ("own", []),
        ("same", ["--side-network", str(same)]),
        ("other", ["--side-network", str(file)]),
    ):
        out = tmp_path / name
        assert main([*words, "--workers", "1", *more, "-o", str(out)]) == 0
        digests.append(estimates_of(out))
    assert digests[0] == digests[1]
    assert digests[0] != digests[2]


def test_what_is_no_network_is_refused(footage, tmp_path, capsys):
    file = tmp_path / "a.npz"
    file.write_text("weights")
    words = ["stress", str(footage), "--variants", "fusion", "--side-network", str(file)]
    assert main([*words, "-o", str(tmp_path / "out")]) == 1
    assert f"{file} is not a network for the sides" in capsys.readouterr().err
