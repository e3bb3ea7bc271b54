# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Two versions of the package in turns."""

import subprocess

import pytest

from benchmarks import versus
from benchmarks.bench.root import ROOT
from benchmarks.versus import Ratio, Worker
from vehicle_pf_tracker.core.errors import InputError


def commit():
    """Return this commit's name; skip the test where there is no repository."""
    words = ["git", "rev-parse", "HEAD"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip("no repository")
    return done.stdout.strip()


def test_a_ratio_is_the_median_of_the_turns():
    # Turns of 2, 1 and 3 times as long; the medians of the times alone would say 0.004 / 0.002.
    ratio = Ratio.of("pf", [0.004, 0.002, 0.006], [0.002, 0.002, 0.002])
    assert (ratio.here_ms, ratio.there_ms, ratio.ratio) == (4.0, 2.0, 2.0)
    assert ratio.spread == pytest.approx(1.0)
    assert versus.table([ratio], "v1.0.0").splitlines()[1].split() == [
        *("pf", "4.000", "ms", "2.000", "ms", "2.00", "+-", "0.50")
    ]


def test_a_toy_compares_a_commit_with_this_tree(tmp_path, capsys):
    of = commit()
    words = ["HEAD", "--toy", "--variants", "ms", "--cache", str(tmp_path)]
    assert versus.main(words) == 0
    name, *numbers = capsys.readouterr().out.splitlines()[-1].split()
    assert name == "ms"
    assert float(numbers[0]) > 0 < float(numbers[4])
    laid_out = tmp_path / "versus" / of
    assert (laid_out / "vehicle_pf_tracker" / "trackers" / "registry.py").exists()
    assert versus.lay_out("HEAD", tmp_path) == laid_out


def test_a_toy_compares_the_step_of_many_vehicles(tmp_path, capsys):
    commit()
    words = ["HEAD", "--toy", "--vehicles", "4", "--cache", str(tmp_path)]
    assert versus.main(words) == 0
    (_, line) = capsys.readouterr().out.splitlines()
    name, *numbers = line.split()
    assert name == "traffic_4"
    assert float(numbers[0]) > 0 < float(numbers[4])


def test_the_other_version_is_what_runs_in_its_process(tmp_path):
    folder = versus.lay_out(commit(), tmp_path)
    registry = folder / "vehicle_pf_tracker" / "trackers" / "registry.py"
    registry.write_text(registry.read_text() + '\nVARIANTS = {"odd": None, **VARIANTS}\n')
    frames = tmp_path / "frames.npz"
    versus.write_frames(frames, 1)
    with Worker(folder, frames) as there, Worker(ROOT, frames) as here:
        assert there.variants == ["odd", *here.variants]


def test_a_commit_that_is_not_there_is_named(tmp_path, capsys):
    commit()
    assert versus.main(["no-such-commit", "--cache", str(tmp_path)]) == 1
    assert "versus: git rev-parse" in capsys.readouterr().err


def test_without_a_release_and_a_commit_nothing_is_compared(monkeypatch, capsys):
    monkeypatch.setattr(versus, "last_release", lambda: None)
    assert versus.main([]) == 0
    assert "nothing is compared" in capsys.readouterr().out


def test_a_version_that_fails_is_named(tmp_path):
    frames = tmp_path / "frames.npz"
    versus.write_frames(frames, 1)
    with Worker(ROOT, frames) as here, pytest.raises(InputError, match="failed at start odd"):
        here.ask("start", "odd", {})
