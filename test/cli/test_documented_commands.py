"""Every command line in docs/evaluation.md is one that the command takes."""

import shlex
from pathlib import Path

import pytest

from vehicle_pf_tracker.cli.main import _parser

PAGE = Path(__file__).parents[2] / "docs" / "evaluation.md"
PROGRAM = "    vehicle-pf-tracker "
LINES = [line for line in PAGE.read_text().splitlines() if line.startswith(PROGRAM)]


@pytest.mark.parametrize("line", LINES)
def test_the_command_is_understood(line):
    words = shlex.split(line)[1:]
    assert _parser(words).parse_args(words).command[1:] == words


def test_there_are_such_commands():
    assert {line.split()[1] for line in LINES} >= {"import", "evaluate", "tune", "replay", "run"}
