"""A folder that appears whole or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError


@contextmanager
def output_errors(folder: Path) -> Iterator[None]:
    """Tell what the system refuses as a mistake about `folder`."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(f"cannot write the recording {folder}: {reason}") from error


class OutputFolder:
    """Collects files in a hidden folder beside `target`, which takes its place at the end.

    Parameters
    ----------
    target : Path
        The folder to make.
    overwrite : bool
        Replace a recording that is there. Anything else than a recording is never replaced.

    Raises
    ------
    InputError
        If `target` is a file or holds files that may not be replaced, or cannot be written.
    """

    def __init__(self, target: Path, overwrite: bool = False) -> None:
        self.target = target.expanduser().resolve()
        self.partial = self.target.parent / f".{self.target.name}.{os.getpid()}.partial"
        with output_errors(target):
            _check_replaceable(self.target, overwrite)
            self.partial.mkdir(parents=True)

    def publish(self) -> None:
        """Put the finished folder in its place."""
        with output_errors(self.target):
            if self.target.exists():
                shutil.rmtree(self.target)
            self.partial.rename(self.target)

    def discard(self) -> None:
        """Remove what was collected."""
        shutil.rmtree(self.partial, ignore_errors=True)


def _check_replaceable(target: Path, overwrite: bool) -> None:
    if not target.exists():
        return
    if not target.is_dir():
        raise InputError(f"the output {target} is a file; name a folder")
    names = [path.name for path in target.iterdir()]
    if not names:
        return
    if not overwrite:
        raise InputError(f"the output folder {target} is not empty; choose another or remove it")
    if any(name != "metadata.yaml" and not name.endswith(".mcap") for name in names):
        raise InputError(f"the output folder {target} holds more than a recording; choose another")
