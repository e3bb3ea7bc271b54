# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mutation testing of a room: what its own tests do not notice when the code is changed.

`python -m tools.mutants ROOM...` copies the repository into a scratch folder, lets mutmut change
the room's modules one place at a time, and runs the tests of that room alone on each change. It
prints every change that survived, and ends with status 1 where fewer than `WANTED` were noticed.
One process, since two compete for the processor and time out. `make mutants` runs the toy.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
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
_NEEDED = "vehicle_pf_tracker", "test", "docs", "config", "conftest.py", "pyproject.toml"
_CONFIGURATION = """[mutmut]
source_paths=vehicle_pf_tracker
only_mutate=vehicle_pf_tracker/{modules}
also_copy=
    conftest.py
    docs
    config
pytest_add_cli_args_test_selection=
    {tests}
pytest_add_cli_args=
    -m
    not slow
use_git_change_detection=false
track_dependencies=false
"""


def survivors(room: str) -> tuple[int, list[str]]:
    """Change the modules of `room`; return the number of changes, and the names of survivors."""
    modules, tests = ROOMS[room]
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name in _NEEDED:
            copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
            copy(ROOT / name, folder / name)
        (folder / "setup.cfg").write_text(_CONFIGURATION.format(modules=modules, tests=tests))
        _mutmut(folder, "run", "--max-children", "1")
        verdicts = dict(
            re.findall(r"^\s*(\S+): (.+)$", _mutmut(folder, "results", "--all", "true"), re.M)
        )
        alive = [name for name, verdict in verdicts.items() if verdict in ALIVE]
        for name in alive:
            print(_mutmut(folder, "show", name))
    return len(verdicts), alive


ALIVE = {"survived", "no tests"}
"""Verdicts of mutmut on a change that no test noticed; a change that never ends is noticed."""


def _mutmut(folder: Path, *words: str) -> str:
    command = [sys.executable, "-m", "mutmut", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"mutmut {words[0]} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def main(rooms: Sequence[str]) -> int:
    """Change each room, and report."""
    if unknown := set(rooms) - set(ROOMS):
        sys.exit(f"no room {', '.join(sorted(unknown))}; choose some of {', '.join(ROOMS)}")
    status = 0
    for room in rooms:
        count, alive = survivors(room)
        share = 1 - len(alive) / max(count, 1)
        print(f"{room}: {count - len(alive)} of {count} changes are noticed ({share:.1%})")
        status |= int(share < WANTED)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
