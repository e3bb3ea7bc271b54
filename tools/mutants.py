# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mutation testing of a room: changes of its code that its own tests do not notice.

`python -m tools.mutants ROOM...` copies the repository into a scratch folder, lets mutmut change
the room's modules one place at a time, and runs on each change those tests of that room that reach
the changed function, until one fails. It prints every change that survived, and ends with status 1
where fewer than `WANTED` were noticed. One process, since two compete for the processor and time
out. `make mutants` runs the toy. `--sample 37` tries a fixed sample: mutmut numbers the changes of
each function, and only those whose number ends in 3 or 7 are tried, about every fifth.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from tools import ROOT

WANTED = 0.95
"""Share of the changes that tests have to notice: some changes make no difference at all, such as
of a bound that no input reaches."""
ROOMS = {
    "filtering": ("filtering/*.py", "test/filtering"),
    "road": ("road/*.py", "test/road"),
    "counting": ("counting/*.py", "test/counting"),
    "papers": ("trackers/papers/*.py", "test/trackers/papers"),
    "toy": ("filtering/weights.py", "test/filtering/test_weights.py"),
}
"""Modules that are changed, and the tests that have to notice, by the room's name."""
COPIED = (
    "vehicle_pf_tracker",
    "laboratory",
    "test",
    "docs",
    "config",
    "conftest.py",
    "pyproject.toml",
)
"""Parts of the repository that the tests need; counting's roads are drawn in the laboratory."""
ALIVE = {"survived", "no tests"}
"""Verdicts of mutmut on a change that no test noticed; a change that never ends is noticed."""
UNTRIED = "not checked"
"""Verdict of mutmut on a change that is not in the sample."""
_CONFIGURATION = """[mutmut]
source_paths=vehicle_pf_tracker
only_mutate=vehicle_pf_tracker/{modules}
also_copy=
    conftest.py
    docs
    config
    laboratory
pytest_add_cli_args_test_selection=
    {tests}
pytest_add_cli_args=
    -m
    not slow
    --hypothesis-seed=0
use_git_change_detection=false
track_dependencies=false
"""

Mutmut = Callable[..., str]
"""Run mutmut in a folder with some words, and return what it prints."""


class Outcome(NamedTuple):
    """Number of changes that were tried, and the names of those that no test noticed."""

    tried: int
    alive: list[str]


def run_mutmut(folder: Path, *words: str) -> str:
    """Run mutmut in a folder, and return what it prints; end this program where it fails."""
    command = [sys.executable, "-m", "mutmut", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"mutmut {words[0]} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def survivors(room: str, sample: str = "", mutmut: Mutmut = run_mutmut) -> Outcome:
    """Change the modules of `room` one place at a time, and print the changes that survive.

    Parameters
    ----------
    room : str
        One of `ROOMS`.
    sample : str
        Last digits of the changes that are tried; all changes are tried if it is empty.
    mutmut : callable
        How mutmut is run.
    """
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        _copy_repository(folder, room)
        mutmut(folder, "run", "--max-children", "1", *(f"*__mutmut_*{digit}" for digit in sample))
        verdicts = _verdicts(mutmut(folder, "results", "--all", "true"))
        alive = [name for name, verdict in verdicts.items() if verdict in ALIVE]
        for name in alive:
            print(mutmut(folder, "show", name))
    return Outcome(len(verdicts), alive)


def _copy_repository(folder: Path, room: str) -> None:
    """Copy into a folder what the tests of a room need, and tell mutmut what it changes there."""
    for name in COPIED:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copy(ROOT / name, folder / name)
    modules, tests = ROOMS[room]
    (folder / "setup.cfg").write_text(_CONFIGURATION.format(modules=modules, tests=tests))


def _verdicts(listed: str) -> dict[str, str]:
    """Read the verdict on each change that was tried from what mutmut lists."""
    return {
        name: verdict
        for name, verdict in re.findall(r"^\s*(\S+): (.+)$", listed, re.M)
        if verdict != UNTRIED
    }


def main(words: Sequence[str]) -> int:
    """Change each room, and report."""
    parser = argparse.ArgumentParser(prog="python -m tools.mutants", description=__doc__)
    parser.add_argument("rooms", nargs="+", metavar="ROOM", help=", ".join(ROOMS))
    parser.add_argument("--sample", default="", metavar="DIGITS", help="last digits of the changes")
    request = parser.parse_args(words)
    if unknown := set(request.rooms) - set(ROOMS):
        sys.exit(f"no room {', '.join(sorted(unknown))}; choose some of {', '.join(ROOMS)}")
    if request.sample.strip("0123456789"):
        sys.exit(f"--sample {request.sample}: name the last digits of the changes, such as 37")
    status = 0
    for room in request.rooms:
        outcome = survivors(room, request.sample)
        noticed = outcome.tried - len(outcome.alive)
        share = noticed / outcome.tried if outcome.tried else 1.0
        of = f"{outcome.tried} sampled changes" if request.sample else f"{outcome.tried} changes"
        print(f"{room}: {noticed} of {of} are noticed ({share:.1%})")
        status |= int(share < WANTED)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
