"""Where the interpreter of the peers is."""

from __future__ import annotations

import os
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError

VARIABLE = "VEHICLE_PF_TRACKER_PEERS"
"""Environment variable that names the interpreter."""

DEFAULT = Path(".venv-peers/bin/python")
"""What `make peers` builds, below the working directory."""


def peer_python(chosen: Path | None = None) -> Path:
    """Find the interpreter that has OpenCV's contrib trackers.

    Parameters
    ----------
    chosen : Path or None
        The user's choice; None takes what `VARIABLE` names, else `DEFAULT`.

    Raises
    ------
    InputError
        If there is no such file.
    """
    python = chosen or Path(os.environ.get(VARIABLE) or DEFAULT)
    if not python.is_file():
        raise InputError(
            f"there is no interpreter {python} to run OpenCV's trackers with; build {DEFAULT} with "
            f"`make peers`, or name another one in the environment variable {VARIABLE}"
        )
    return python.absolute()  # not resolved: a link is what makes it the environment's
