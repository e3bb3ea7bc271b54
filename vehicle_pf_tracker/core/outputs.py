# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The rule for outputs: an input is never one, what exists is kept, and one command uses it.

Also here: folders that appear whole or not at all (`whole_folder`).
"""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.core.errors import InputError

BAG_INFORMATION = "metadata.yaml"
"""File that makes a folder a rosbag2 recording."""
_FILE_URL = "file://"
"""Beginning of a URL of a file on this machine."""


@dataclass(frozen=True, slots=True)
class Products:
    """Folder that a command puts files into, beside whatever else it holds.

    Attributes
    ----------
    names : sequence of str
        Patterns of the files and folders that the command replaces; none where it resumes.
    """

    folder: Path
    names: Sequence[str] = ()


Output: TypeAlias = Path | Products
"""Output of a command: a file or a folder that it replaces as a whole, or products."""


@contextmanager
def claimed(
    outputs: Iterable[Output | None], inputs: Iterable[str | Path | None], *, overwrite: bool
) -> Iterator[None]:
    """Keep all outputs of a command for it alone, from before its work until its end.

    Folders on the way to an output are made, and removed again if they stay empty.

    Parameters
    ----------
    outputs : iterable of Path, Products or None
        The outputs; None is one that is not asked for.
    inputs : iterable of str, Path or None
        What the command reads: paths, and URLs and cameras, which cannot be harmed.
    overwrite : bool
        Let outputs replace what exists.

    Raises
    ------
    InputError
        If an output is an input, by whatever name, or another output; if it exists and is not to be
        replaced; if another process has it; or if it cannot be written.
    """
    read = [_input(one) for one in inputs if one is not None]
    places: list[Path] = []
    with ExitStack() as claims:
        for output in outputs:
            if output is None:
                continue
            place = output.folder if isinstance(output, Products) else output
            if any(_is_same(place, one) for one in places):
                raise InputError(f"{place} is given for two outputs; name another")
            places.append(place)
            _check_not_read(place, _replaced(output), [path for path in read if path.exists()])
            claims.enter_context(_alone_with(output))
            for path in _replaced(output) if not overwrite else ():
                check_free(path)
        yield


def check_free(path: Path) -> None:
    """Check that there is no file, and no folder with content, at `path`.

    Raises
    ------
    InputError
        If there is one.
    """
    with output_errors(path):
        if path.is_dir() and not any(path.iterdir()):
            return
        if path.exists():
            state = "is not empty" if path.is_dir() else "exists"
            raise InputError(f"{path} {state}; give --overwrite to replace it, or name another")


@contextmanager
def output_errors(path: Path) -> Iterator[None]:
    """Report errors of the operating system as an `InputError` about `path`."""
    try:
        yield
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error


def _input(given: str | Path) -> Path:
    """Return the file or folder that is read; the whole recording where its MCAP file is given."""
    path = Path(str(given).removeprefix(_FILE_URL))
    return path.parent if (path.parent / BAG_INFORMATION).is_file() else path


def _replaced(output: Output) -> list[Path]:
    """Return what a command replaces by writing this output."""
    if isinstance(output, Products):
        return [path for name in output.names for path in output.folder.glob(name)]
    return [output]


def _check_not_read(place: Path, replaced: Iterable[Path], inputs: Iterable[Path]) -> None:
    for path in inputs:
        # A picture that is put into a folder of images would be one of them from then on.
        is_inside = path.is_dir() and _is_in(place, path)
        if is_inside or any(_takes_away(one, path) for one in replaced):
            raise InputError(f"the output {place} would change the input {path}; name another")


def _takes_away(output: Path, read: Path) -> bool:
    """Return whether replacing `output` takes away `read`, or a file in it."""
    if output.is_dir():
        return _is_in(read, output)
    files = read.rglob("*") if read.is_dir() and output.exists() else [read]
    return any(_is_same(output, file) for file in files)


def _is_in(path: Path, folder: Path) -> bool:
    """Return whether `path` is the folder, or lies in it at any depth."""
    return any(_is_same(one, folder) for one in (path, *path.resolve().parents))


def _is_same(one: Path, other: Path) -> bool:
    """Return whether two names lead to one place, through links of either kind."""
    return one.resolve() == other.resolve() or (
        one.exists() and other.exists() and one.samefile(other)
    )


@contextmanager
def _alone_with(output: Output) -> Iterator[None]:
    """Hold a lock file, gone afterwards, which the system frees if the process dies."""
    if isinstance(output, Products):
        folder = output.folder
        lock = output.folder / ".lock"
        named = output.folder
    else:
        folder = output.resolve().parent
        lock = folder / f".{output.resolve().name}.lock"
        named = output
    with output_errors(folder):
        if folder.exists() and not folder.is_dir():
            raise InputError(f"the output {folder} is a file; name a folder")
        made = [one for one in (folder, *folder.parents) if not one.exists()]
        folder.mkdir(parents=True, exist_ok=True)
    try:
        with output_errors(named):
            descriptor = _lock(lock)
        if descriptor is None:
            raise InputError(
                f"another command is at work in {named}; wait for it, or name another output"
            )
        try:
            yield
        finally:
            lock.unlink(missing_ok=True)
            os.close(descriptor)
    finally:
        with suppress(OSError):  # they hold something
            for one in made:
                one.rmdir()


def _lock(path: Path) -> int | None:
    """Lock a file and return its descriptor; None if another process has it."""
    # filelock leaves its file, which here is among the user's results, after the lock is gone.
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # Whoever held it before may have removed the name between the two calls.
            if path.exists() and os.path.samestat(os.fstat(descriptor), path.stat()):
                return descriptor
        except BlockingIOError:
            os.close(descriptor)
            return None
        except BaseException:  # a signal too
            os.close(descriptor)
            raise
        os.close(descriptor)


@contextmanager
def whole_folder(target: Path) -> Iterator[Path]:
    """Yield a hidden folder beside `target` to fill; if the block ends well it takes its place.

    What is there under its name is replaced; after an error the hidden folder is removed.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    target = target.expanduser().resolve()
    partial = target.parent / f".{target.name}.{os.getpid()}.partial"
    former = partial.with_suffix(".former")
    partial.mkdir(parents=True)
    try:
        yield partial
        if target.exists():
            target.rename(former)
        partial.rename(target)
    except BaseException:  # a signal too
        if former.exists() and not target.exists():
            former.rename(target)
        raise
    finally:
        shutil.rmtree(former, ignore_errors=True)
        shutil.rmtree(partial, ignore_errors=True)
