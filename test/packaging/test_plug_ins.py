# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Variants of other distributions: found, run, and kept from harming the package's own."""

import csv
import json
import os
import subprocess
import sys

import pytest
from plug_in_sample import install
from small_recordings import TARGET, record

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.registry import NODES, find_node, find_variant, plug_ins

RUN = "from vehicle_pf_tracker.cli.main import main; raise SystemExit(main())"


@pytest.fixture(scope="module")
def verb(tmp_path_factory):
    """Run a verb where the plug-in is installed; returns what it printed."""
    site = install(tmp_path_factory.mktemp("plug_in"))
    path = os.pathsep.join([str(site), *sys.path])

    def run(*words):
        done = subprocess.run(
            [sys.executable, "-c", RUN, *map(str, words)],
            env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


def test_a_plug_in_runs_and_is_evaluated(verb, tmp_path):
    assert "    trust: 0.8\n" in verb("params", "steady")
    rec = record(tmp_path / "rec")
    verb("run", rec, "--variant", "steady", "--target", TARGET, "--set", "trust=0.5",
         "-o", tmp_path / "out")  # fmt: skip
    with (tmp_path / "out" / "estimates.csv").open() as file:
        assert {row["mode"] for row in csv.DictReader(file)} == {"TRACKING"}
    assert json.loads((tmp_path / "out" / "metrics.json").read_text())["success_auc"] > 0.5
    words = ("--variants", "steady,pf", "--seeds", 1, "--workers", 1)
    told = verb("evaluate", rec, *words, "-o", tmp_path / "results")
    assert "steady" in told
    assert "pf" in told


@pytest.fixture
def declare(tmp_path, monkeypatch):
    """Install a distribution that declares these entry points, and has these modules."""

    def install_points(points, **modules):
        info = tmp_path / "others-2.1.dist-info"
        info.mkdir()
        (info / "METADATA").write_text("Name: others\nVersion: 2.1\n")
        (info / "entry_points.txt").write_text(f"[vehicle_pf_tracker.variants]\n{points}\n")
        for name, text in modules.items():
            (tmp_path / f"{name}.py").write_text(text)
        monkeypatch.syspath_prepend(tmp_path)
        plug_ins.cache_clear()

    yield install_points
    plug_ins.cache_clear()


def test_a_plug_in_that_cannot_be_imported_harms_no_other(declare):
    declare("torn = torn_module:TornTracker", torn_module="import a_library_of_nobody")
    torn = find_node("torn")
    sentence = "torn, a plug-in of others 2.1, cannot be loaded: No module named 'a_library_of_nob"
    with pytest.raises(InputError, match=sentence):
        _ = torn.tracker
    assert find_variant("pf") is NODES["pf"]
    with pytest.raises(InputError, match=r"choose one of apf, .*, torn$"):
        find_variant("kalman")


@pytest.mark.parametrize("name", ["fusion", "traffic", "my-filter"])
def test_a_name_that_cannot_be_taken_is_left_out_with_a_warning(declare, caplog, name):
    declare(f"{name} = others:OtherTracker")
    assert find_node("fusion") is NODES["fusion"]
    assert name not in plug_ins()
    (told,) = [one.getMessage() for one in caplog.records]
    assert told.startswith(f"{name!r}, a plug-in of others 2.1, is left out")
