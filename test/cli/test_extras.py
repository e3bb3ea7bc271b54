# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Verbs without the libraries of the extra `evaluation`."""

from __future__ import annotations

import subprocess
import sys

import pytest

from vehicle_pf_tracker.cli import main as command


@pytest.fixture(params=command.EVALUATION_MODULES)
def absent(request, monkeypatch):
    """The name of a library that cannot be imported, as if it were not installed."""
    monkeypatch.setitem(sys.modules, request.param, None)
    return request.param


@pytest.mark.parametrize("verb", sorted(command.EVALUATING))
def test_a_verb_that_lacks_its_extra_says_what_to_install(capsys, absent, verb):
    assert command.main([verb, "somewhere", "-o", "nowhere"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{verb} needs the Python module {absent}" in line
    assert "pip install 'vehicle_pf_tracker[evaluation]'" in line


def on_a_robot(*words, **options):
    """Run the command in a process in which none of the libraries can be imported."""
    code = (
        "import sys; from vehicle_pf_tracker.cli.main import EVALUATION_MODULES, main\n"
        "sys.modules.update(dict.fromkeys(EVALUATION_MODULES)); sys.exit(main())"
    )
    command_line = [sys.executable, "-c", code, *map(str, words)]
    return subprocess.run(command_line, capture_output=True, text=True, check=False, **options)


@pytest.mark.parametrize("verb", sorted(set(command.VERBS) - command.EVALUATING))
def test_the_other_verbs_load_without_it(verb):
    done = on_a_robot(verb, "--help")
    assert done.returncode == 0, done.stderr
    assert f"usage: vehicle-pf-tracker {verb}" in done.stdout


def test_a_recording_is_made_and_tracked_without_it(tmp_path):
    made = on_a_robot("synth", "bar", tmp_path / "recording")
    assert made.returncode == 0, made.stderr  # a slow machine shows progress there
    words = ("--variant", "pf", "--set", "kernels=opencv", "-o", tmp_path / "out")
    run = on_a_robot("run", tmp_path / "recording", *words)
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "out" / "metrics.json").is_file()
