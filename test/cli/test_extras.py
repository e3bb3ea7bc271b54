# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Verbs without the libraries of the extra `evaluation`."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from vehicle_pf_tracker.cli import main as command
from vehicle_pf_tracker.cli.missing_modules import EVALUATING, EVALUATION_MODULES


@pytest.fixture(params=EVALUATION_MODULES)
def absent(request, monkeypatch):
    """The name of a library that cannot be imported, as if it were not installed."""
    monkeypatch.setitem(sys.modules, request.param, None)
    return request.param


WORDS = {
    "evaluate": ["somewhere", "-o", "nowhere"],
    "tune": ["somewhere", "--variant", "pf", "-o", "nowhere"],
    "merge": ["somewhere", "-o", "nowhere"],
    "report": ["somewhere"],
}


@pytest.mark.parametrize("verb", sorted(EVALUATING))
def test_a_verb_that_lacks_its_extra_says_what_to_install(capsys, absent, verb):
    assert command.main([verb, *WORDS[verb]]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{verb} needs the Python module {absent}" in line
    assert "pip install 'vehicle_pf_tracker[evaluation]'" in line


ABSENT = (*EVALUATION_MODULES, "optuna", "av", "onnxruntime", "pooch", "numba", "rclpy")


def on_a_robot(*words, **options):
    """Run the command in a process in which none of the libraries can be imported."""
    code = (
        "import sys; from vehicle_pf_tracker.cli.main import main\n"
        f"sys.modules.update(dict.fromkeys({ABSENT!r})); sys.exit(main())"
    )
    command_line = [sys.executable, "-c", code, *map(str, words)]
    return subprocess.run(command_line, capture_output=True, text=True, check=False, **options)


# Of words that end before anything is done: status, and what is printed.
ANSWERS = """
import contextlib, io, json, sys
from vehicle_pf_tracker.cli.main import main
sys.modules.update(dict.fromkeys({absent!r}))
def answer(words):
    with contextlib.redirect_stdout(io.StringIO()) as out:
        with contextlib.redirect_stderr(io.StringIO()) as err:
            status = main(words)
    return status, out.getvalue(), err.getvalue()
print(json.dumps([answer(words) for words in json.loads(sys.argv[1])]))
"""
USAGES = [["evaluate", "a", "-o", "b", "--seeds", "x"], ["tune", "--help"], ["report"]]


@pytest.fixture(scope="module")
def answers():
    """Status, output and errors by command line, all of one process on a robot."""
    asked = [*([verb, "--help"] for verb in command.VERBS), *USAGES]
    words = [sys.executable, "-c", ANSWERS.format(absent=ABSENT), json.dumps(asked)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    return {tuple(words): answer for words, answer in zip(asked, found, strict=True)}


@pytest.mark.parametrize("verb", command.VERBS)
def test_every_verb_has_its_help_without_it(answers, verb):
    status, out, err = answers[verb, "--help"]
    assert status == 0, err
    assert f"usage: vehicle-pf-tracker {verb}" in out


def test_a_recording_is_made_and_tracked_without_it(tmp_path):
    made = on_a_robot("synth", "bar", tmp_path / "recording", "--set", "speed=20")
    assert made.returncode == 0, made.stderr  # a slow machine shows progress there
    words = ("--variant", "pf", "--set", "kernels=opencv", "-o", tmp_path / "out")
    run = on_a_robot("run", tmp_path / "recording", *words)
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "out" / "metrics.json").is_file()


def test_a_shell_s_completion_is_written_without_it():
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({ABSENT!r}))\n"
        "from vehicle_pf_tracker.cli.main import make_parser\n"
        "print(len(make_parser()._subparsers._group_actions[0].choices))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(done.stdout) == len(command.VERBS)


@pytest.mark.parametrize(("words", "status"), list(zip(USAGES, (2, 0, 2), strict=True)))
def test_usage_is_told_before_what_is_missing(answers, words, status):
    found, _, err = answers[tuple(words)]
    assert found == status
    assert "needs the Python module" not in err
