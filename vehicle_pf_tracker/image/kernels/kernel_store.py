# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Object code of kernels on disk, so that each is compiled once on a machine."""

from __future__ import annotations

import functools
import hashlib
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from importlib import metadata
from pathlib import Path

import llvmlite.binding as llvm
import numpy as np

from vehicle_pf_tracker.image.kernels.object_code import ObjectCode, from_bytes, to_bytes

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
            return from_bytes((folder / _file_name(module, name, source)).read_bytes())
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
            # Under another name until it is whole: other processes read meanwhile.
            with tempfile.NamedTemporaryFile(dir=folder, delete=False) as part:
                part.write(to_bytes(compiled))
            Path(part.name).replace(file)
        except OSError as error:
            problem = error
            continue
        _remove_older(file)
        return
    raise problem


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
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    if chosen:
        yield Path(chosen) / "vehicle_pf_tracker"
        return
    yield Path(__file__).parent / "__pycache__"
    # A package that root installed: each user has a cache.
    users = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    yield Path(users) / "vehicle_pf_tracker" / "kernels"


def _file_name(module: str, name: str, source: str) -> str:
    of_source = hashlib.sha256(source.encode()).hexdigest()[:_DIGITS]
    return f"{module.rpartition('.')[2]}.{name}.{_machine()}-{of_source}.kernel"


def _remove_older(file: Path) -> None:
    """Remove what the same kernel was before its source changed."""
    for older in file.parent.glob(f"{file.name.rpartition('-')[0]}-*.kernel"):
        if older != file:
            with suppress(OSError):  # another process was first
                older.unlink()


@functools.cache
def _machine() -> str:
    """Digest of what object code depends on beside its source."""
    parts = [
        sys.implementation.cache_tag,
        np.__version__,
        metadata.version("numba"),
        metadata.version("llvmlite"),
        llvm.get_process_triple(),
        llvm.get_host_cpu_name(),
        llvm.get_host_cpu_features().flatten(),
    ]
    # They may choose another processor, or another optimisation.
    parts += [
        f"{name}={value}"
        for name, value in sorted(os.environ.items())
        if name.startswith("NUMBA_") and name != "NUMBA_CACHE_DIR"
    ]
    return hashlib.sha256("\n".join(map(str, parts)).encode()).hexdigest()[:_DIGITS]
