# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A fresh environment of Python in which an archive is installed with one of its extras."""

from __future__ import annotations

import sys
from pathlib import Path

from tools import ROOT
from tools.release.commands import run


def interpreter(version: str | None) -> Path:
    """Return the interpreter of a version, as `3.12`, on PATH; None is that of this process."""
    if version is None:
        return Path(sys.executable)
    return Path(run(ROOT / ".ci" / "find-python", version, cwd=ROOT).strip())


def install(archive: Path, extra: str, folder: Path, version: str | None = None) -> Path:
    """Install an archive with an extra into a fresh environment, and return its Python.

    Parameters
    ----------
    archive : Path
        Wheel or source archive.
    extra : str
        Extra that it is installed with.
    folder : Path
        Folder of the environment, which is made.
    version : str, optional
        Version of Python, that of this process if left out.
    """
    run(interpreter(version), "-m", "venv", "--symlinks", "--without-pip", folder, cwd=ROOT)
    python = folder / "bin" / "python"
    # The pip of this process, so that the environment's size is that of what the extra brings.
    pip = (sys.executable, "-m", "pip", "--python", python, "--disable-pip-version-check")
    run(*pip, "install", "--quiet", f"{archive.absolute()}[{extra}]", cwd=folder)
    return python


def megabytes(python: Path) -> int:
    """Return the size of the site-packages beside a Python, MB, as `du -sm` has it."""
    (folder,) = python.parents[1].glob("lib/python*/site-packages")
    return int(run("du", "-sm", folder, cwd=folder).split()[0])
