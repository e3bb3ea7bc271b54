"""One command at a time in a folder of results."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.output_files import output_errors

_NAME = ".lock"


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Keep other commands out of `folder`; a process that dies lets them in again.

    Raises
    ------
    InputError
        If another one is at work there, or the folder cannot be written.
    """
    with output_errors(folder):
        file = (folder / _NAME).open("w")
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(
                f"another command is at work in {folder}; wait for it, or name another folder"
            ) from None
        yield
