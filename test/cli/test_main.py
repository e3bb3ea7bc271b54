# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import importlib
import os
import re
import subprocess
import sys
from dataclasses import fields

import pytest

from vehicle_pf_tracker import __version__
from vehicle_pf_tracker.cli import main as command
from vehicle_pf_tracker.cli import params
from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.core.errors import InputError

MODULE = (sys.executable, "-m", "vehicle_pf_tracker")


@pytest.fixture
def failing(monkeypatch):
    """Let the verb `params` end with an error."""

    def fail_with(error):
        def run(args):
            raise error

        monkeypatch.setattr(params, "run", run)
        return command.main(["params", "apf"])

    return fail_with


def test_help_lists_every_verb(capsys):
    assert command.main(["--help"]) == 0
    text = capsys.readouterr().out
    assert all(re.search(rf"^    {verb}\b", text, re.MULTILINE) for verb in command.VERBS)


@pytest.mark.parametrize("verb", command.VERBS)
def test_every_verb_has_help_of_its_own(capsys, verb):
    assert command.main([verb, "--help"]) == 0
    assert f"usage: vehicle-pf-tracker {verb}" in capsys.readouterr().out


def test_a_parser_of_all_verbs_has_their_options():
    parser = command.make_parser()
    assert parser.parse_args(["import", "a", "b", "--fps", "5"]).fps == 5.0
    assert parser.parse_args(["road", "calibrate", "a"]).action == "calibrate"


@pytest.mark.parametrize(
    ("verb", "field", "name", "words"),
    [
        ("params", "variant", "traffic", ["nope"]),
        ("run", "variant", "fusion", ["v.mp4", "--variant", "nope"]),
        ("synth", "scene", "bridge", ["nope", "out"]),
    ],
)
def test_a_shell_completes_names_and_the_verb_refuses_others(capsys, verb, field, name, words):
    """A program that writes completions reads the choices of the parser."""
    module = importlib.import_module(f"vehicle_pf_tracker.cli.{verb}")
    declared = {
        one.name: one.metadata["settings"] for one in fields(module.Request) if one.metadata
    }
    assert name in list(declared[field]["choices"])
    words = {"params": ["nope"], "run": ["v.mp4", "--variant", "nope"], "synth": ["nope", "o"]}[
        verb
    ]
    assert command.main([verb, *words]) == 1
    assert "'nope'" in capsys.readouterr().err


def test_help_loads_nothing_heavy():
    code = (
        "import sys; from vehicle_pf_tracker.cli.main import main; main(['--help']);"
        "print(sorted({'numpy', 'cv2', 'rich', 'matplotlib', 'mcap', 'rclpy'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_version(capsys):
    assert command.main(["--version"]) == 0
    assert capsys.readouterr().out == f"vehicle-pf-tracker {__version__}\n"


@pytest.mark.parametrize("words", [[], ["params"], ["params", "apf", "--wings"]])
def test_wrong_usage_is_2_with_the_usage_on_stderr(capsys, words):
    assert command.main(words) == 2
    assert "usage: vehicle-pf-tracker" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("error", "status", "line"),
    [
        (InputError("the thing\nis broken"), 1, "vehicle-pf-tracker: error: the thing is broken\n"),
        (UsageError("say which"), 2, "vehicle-pf-tracker: error: say which\n"),
        (OSError(28, "No space left on device", "out.csv"), 1,
         "vehicle-pf-tracker: error: out.csv: No space left on device\n"),
        (OSError("odd"), 1, "vehicle-pf-tracker: error: odd\n"),
        (KeyboardInterrupt(), 130, ""),
    ],
)  # fmt: skip
def test_errors_become_one_line_and_a_status(capsys, failing, error, status, line):
    assert failing(error) == status
    assert capsys.readouterr().err == line


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("rclpy", "pip install 'vehicle_pf_tracker[ros]'"),
        ("sensor_msgs.msg", "module sensor_msgs is not there: source ROS's setup.bash"),
        ("onnxruntime", "install the extra [video], pip install 'vehicle_pf_tracker[video]'"),
        ("av", "pip install 'vehicle_pf_tracker[video]'"),
        ("mcap.writer", "the Python module mcap is not there: it belongs to every installation"),
    ],
)
def test_a_missing_library_is_named_with_what_brings_it(capsys, failing, module, words):
    assert failing(ModuleNotFoundError("no", name=module)) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert words in line


def test_a_fault_of_the_program_is_not_hidden(failing):
    with pytest.raises(ZeroDivisionError):
        failing(ZeroDivisionError())
    with pytest.raises(ModuleNotFoundError):
        failing(ModuleNotFoundError("no", name="vehicle_pf_tracker.wings"))


def test_a_reader_that_leaves_early_is_no_error():
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [*MODULE, "params", "apf"],
        stdout=write, stderr=subprocess.PIPE, text=True, check=False,
    )  # fmt: skip
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize("words", [["params", "ms"], ["params", "nope"], ["nope"], ["--version"]])
def test_the_package_as_a_module_is_the_command(words, capsys):
    status = command.main(words)
    told = capsys.readouterr()
    done = subprocess.run([*MODULE, *words], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (status, told.out, told.err)


def test_a_box_that_the_left_border_cuts_is_no_option(capsys):
    words = ["run", "nothing.mp4", "--target", "-3.5,97,46,26"]
    assert command.main(words) == 1
    assert "there is no file or folder nothing.mp4" in capsys.readouterr().err
    assert command.main([*words, "--overwrite", "-3.5,97,46,26", "--target"]) == 2


def test_bag_replay_is_the_verb_replay(capsys):
    assert command.bag_replay(["--help"]) == 0
    assert "usage: vehicle-pf-tracker replay" in capsys.readouterr().out
