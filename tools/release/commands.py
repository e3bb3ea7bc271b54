# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands that the checks run, away from any ROS workspace; one that fails speaks against it."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

_HIDDEN = {"AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "PYTHONPATH", "PYTHONUSERBASE", "COLCON"}
"""Variables by which a command would find packages of this shell instead of those it was given."""


class ReleaseError(Exception):
    """Reason against a release, one sentence."""


def run(*command: object, cwd: Path, **variables: object) -> str:
    """Run a command without what this shell has sourced, and return what it prints.

    Parameters
    ----------
    *command : object
        Its words.
    cwd : Path
        Folder in which it runs.
    **variables : object
        Variables of its environment over those of this process.

    Raises
    ------
    ReleaseError
        If it fails.
    """
    environment = {name: value for name, value in os.environ.items() if name not in _HIDDEN}
    environment.update({name: str(value) for name, value in variables.items()})
    words = list(map(str, command))
    done = subprocess.run(
        words, cwd=cwd, env=environment, text=True, capture_output=True, check=False
    )
    if done.returncode:
        raise ReleaseError(
            f"`{' '.join(words)}` ends with {done.returncode}:\n{done.stdout}{done.stderr}"
        )
    return done.stdout
