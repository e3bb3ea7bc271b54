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
