# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Small files of the nodes' own, in ROS's folder, which nobody else reads."""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError

_MOST_BYTES = 4096
"""Bytes of a file that is read: ours have a hundred."""


def ros_folder() -> Path:
    """Return our folder in that of ROS."""
    return Path(os.environ.get("ROS_HOME") or Path.home() / ".ros", "vehicle_pf_tracker")


def own_name(node: str) -> str:
    """Return what the files of a node begin with, whose full name is given."""
    return node.strip("/").replace("/", ".")


def own_file(node: str, ending: str) -> Path:
    """Return the path of a file of a node, whose full name is given."""
    return ros_folder() / f"{own_name(node)}.{ending}"


def write_private(path: Path, text: str) -> None:
    """Write a file in one go, which only its owner may read.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    partial = path.with_name(f"{path.name}.partial")
    path.parent.mkdir(parents=True, exist_ok=True)
    with suppress(FileNotFoundError):
        partial.unlink()  # whatever is there: a pipe would be waited for, a link followed
    descriptor = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(text)
    partial.replace(path)


def read_small(path: Path) -> tuple[str, float]:
    """Return the text of a file, and the time at which it was written, in s since 1970.

    Raises
    ------
    OSError
        If it cannot be read.
    InputError
        If it is not a small regular file of text.
    """
    # Without waiting: opening a pipe ends when somebody writes to it, which may be never.
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    with os.fdopen(descriptor, "rb") as file:
        state = os.fstat(descriptor)
        if not stat.S_ISREG(state.st_mode):
            raise InputError(f"{path} is not a regular file")
        text = file.read(_MOST_BYTES + 1)
    if len(text) > _MOST_BYTES:
        raise InputError(f"{path} has more than {_MOST_BYTES} bytes")
    try:
        return text.decode("utf-8"), state.st_mtime
    except UnicodeDecodeError:
        raise InputError(f"{path} is not text") from None
