# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""An archive as its users get it: installed with an extra, and used as the README shows for that.

It has no more than the extra that the README names, so what that lacks is noticed here.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from tools.release import journeys
from tools.release.commands import ReleaseError, run
from tools.release.environment import install, megabytes
from tools.release.licences import check_licences, licences_in

MOST_MEGABYTES: Mapping[str, int] = {"video": 690, "ros": 760, "evaluation": 830}
"""Largest site-packages by extra, MB: a twentieth above docs/development.md, so that what a new
release of a library adds is noticed."""


def check_installation(archive: Path, extra: str, version: str | None = None) -> str:
    """Check an archive with an extra in a fresh environment; return its size and the licences.

    Parameters
    ----------
    archive : Path
        Wheel or source archive.
    extra : str
        Extra that it is installed with, one of `MOST_MEGABYTES`.
    version : str, optional
        Version of Python, as `3.12`; that of this process if left out.
    """
    with TemporaryDirectory(prefix="release-check-") as scratch:
        python = install(archive, extra, Path(scratch, "env"), version)
        # Measured before anything is run: Python leaves its bytecode beside what it imports.
        size = megabytes(python)
        stated = check_licences(licences_in(python))
        _follow_readme(python, extra, Path(scratch, "work"))
    if size > MOST_MEGABYTES[extra]:
        raise ReleaseError(f"[{extra}] takes {size} MB, more than {MOST_MEGABYTES[extra]}")
    return f"{size} MB; {stated}"


def _follow_readme(python: Path, extra: str, folder: Path) -> None:
    """Type the README's commands for an extra in an empty folder, and judge what they leave."""
    folder.mkdir()
    # Some of them start nodes in the background, which end with the shell.
    script = f"trap 'kill $(jobs -p) || true' EXIT\nset -e\n{journeys.commands(extra)}"
    variables = {
        "PATH": f"{python.parent}:{os.environ['PATH']}",
        "ROS_DOMAIN_ID": 1 + os.getpid() % 100,  # not that of nodes beside this one
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }
    run("bash", "-c", script, cwd=folder, **variables)
    if problem := journeys.problem(extra, folder):
        raise ReleaseError(f"the README's commands for [{extra}]: {problem}")
