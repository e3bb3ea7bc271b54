# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Object code of kernels on disk, so that each is compiled once on a machine."""

from __future__ import annotations

import functools
import hashlib
import os
import pkgutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from importlib import metadata
from pathlib import Path

import llvmlite.binding as llvm
import numpy as np

from vehicle_pf_tracker.image.kernels.toolchain.object_code import ObjectCode, from_bytes, to_bytes

_MADE_BY = ("compilation.py", "whole_kernels.py", "object_code.py", "arguments.py")
"""Modules whose change makes other object code, or another file of it."""
_DIGITS = 12
"""Digits of a sum in a file's name: some dozen files of a folder are told apart by far fewer."""


def read(module: str, name: str, source: str) -> ObjectCode | None:
    """Return the object code of a kernel that was compiled before, None where there is none.

    Parameters
    ----------
    module, name : str
        Of the kernel.
    source : str
        All that its code follows from; see `Kernel.source`.
    """
    for folder in _folders():
        with suppress(OSError):
            compiled = from_bytes((folder / _file_name(module, name, source)).read_bytes())
            # A torn one that cannot be replaced does not hide that of another folder.
            if compiled is not None:
                return compiled
    return None


def write(module: str, name: str, source: str, compiled: ObjectCode) -> None:
    """Keep object code in the first folder that can be written; parameters as for `read`.

    Raises
    ------
    OSError
        If there is no such folder.
    """
    problem: OSError = OSError("there is no folder for them")
    for folder in _folders():
        file = folder / _file_name(module, name, source)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            _write_whole(file, to_bytes(compiled))
        except OSError as error:
            problem = error
            continue
        _remove_older(file)
        return
    raise problem


def _write_whole(file: Path, content: bytes) -> None:
    """Write a file under another name until it is whole: other processes read meanwhile."""
    with tempfile.NamedTemporaryFile(dir=file.parent, delete=False) as part:
        try:
            part.write(content)
            part.close()
            Path(part.name).replace(file)
        except OSError:
            Path(part.name).unlink(missing_ok=True)
            raise


def has_any() -> bool:
    """Tell whether anything was compiled with the numba, Python and processor of this process."""
    return any(
        file
        for folder in _folders()
        if folder.is_dir()
        for file in folder.glob(f"*.{_machine()}-*.kernel")
    )


def _folders() -> Iterator[Path]:
    """List the folders to look in and to write to, the first one first."""
    # The room of the kernels, which stand beside this one.
    here = Path(__file__).parents[1]
    # Two installations that share a folder would else remove each other's as older ones.
    own = hashlib.sha256(os.fsencode(here)).hexdigest()[:_DIGITS]
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    if chosen:
        yield Path(chosen) / "vehicle_pf_tracker" / own
        return
    yield here / "__pycache__"
    # A package that root installed: each user has a cache.
    users = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    yield Path(users) / "vehicle_pf_tracker" / "kernels" / own


def _file_name(module: str, name: str, source: str) -> str:
    of_source = hashlib.sha256(source.encode()).hexdigest()[:_DIGITS]
    return f"{module.rpartition('.')[2]}.{name}.{_machine()}-{of_source}.kernel"


def _remove_older(file: Path) -> None:
    """Remove what the same kernel was before its source changed."""
    for older in file.parent.glob(f"{file.name.rpartition('-')[0]}-*.kernel"):
        if older != file:
            with suppress(OSError):  # another process was first
                older.unlink()


def _machine() -> str:
    """Digest of what object code depends on beside its source."""
    # They may choose another processor, or another optimisation.
    settings = [
        f"{name}={value}"
        for name, value in sorted(os.environ.items())
        if name.startswith("NUMBA_") and name != "NUMBA_CACHE_DIR"
    ]
    return hashlib.sha256("\n".join([*_installed(), *settings]).encode()).hexdigest()[:_DIGITS]


@functools.cache
def _installed() -> tuple[str, ...]:
    """Name the libraries and the processor of this process, which stay, and how code is made."""
    parts = [
        sys.implementation.cache_tag,
        np.__version__,
        metadata.version("numba"),
        metadata.version("llvmlite"),
        llvm.get_process_triple(),
        llvm.get_host_cpu_name(),
        llvm.get_host_cpu_features().flatten(),
    ]
    # How code is made and written. Read, as compilation imports numba.
    parts += [pkgutil.get_data(__package__, name) for name in _MADE_BY]
    return tuple(map(str, parts))
