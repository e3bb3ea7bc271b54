# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Recordings at URLs, copied to this machine once per process.

fsspec reads them, so that every store it has a driver for will do: https:// and file:// as it
comes, s3:// with s3fs beside it, gs:// with gcsfs.
"""

from __future__ import annotations

import atexit
import functools
import importlib
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast
from urllib.parse import urlsplit

from vehicle_pf_tracker.core.errors import InputError

AnswerT = TypeVar("AnswerT")


def recordings_at(url: str) -> list[str]:
    """Return the URLs of the recordings that a URL names: itself, or those in its folder.

    Raises
    ------
    InputError
        If there is none, or the store does not answer.
    """
    system, path = _file_system(url)

    def children(folder: str) -> list[str]:
        return sorted(system.ls(folder, detail=False)) if system.isdir(folder) else []

    def look() -> list[str]:
        if not system.exists(path):
            raise InputError(f"there is no recording {url}")
        # A folder that is one recording is not searched for others.
        if not system.isdir(path) or _holds_recording(children(path)):
            return [path]
        return [
            child
            for child in children(path)
            if child.endswith(".mcap") or _holds_recording(children(child))
        ]

    paths = _asked(url, look)
    if not paths:
        raise InputError(f"the folder {url} is not a recording and holds none")
    return [str(system.unstrip_protocol(name)) for name in paths]


@functools.cache
def local_copy(url: str) -> Path:
    """Return a copy of the recording at a URL, which goes with this process.

    Raises
    ------
    InputError
        If it cannot be fetched.
    """
    folder = Path(tempfile.mkdtemp(prefix="vehicle-pf-tracker-"))
    # The copy may be large, and is of no use to the next process, which makes its own.
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return fetched(url, folder)


def fetched(url: str, folder: Path) -> Path:
    """Copy the recording or the file at a URL into a folder, and return the copy.

    Raises
    ------
    InputError
        If it cannot be fetched.
    """
    system, path = _file_system(url)
    # The name is kept: readers recognise recordings by their suffix.
    target = folder / path.rstrip("/").rsplit("/", 1)[-1]

    def fetch() -> Path:
        if not system.isdir(path):
            system.get_file(path, str(target))
            return target
        target.mkdir()
        for child in system.ls(path, detail=False):
            # What is not of the recording stays where it is: it may be large.
            if child.endswith((".mcap", "metadata.yaml")):
                system.get_file(child, str(target / child.rsplit("/", 1)[-1]))
        return target

    return _asked(url, fetch)


def _holds_recording(children: list[str]) -> bool:
    return any(child.endswith((".mcap", "/metadata.yaml")) for child in children)


def _file_system(url: str) -> tuple[Any, str]:
    # Refused before the store is asked: nothing with a password in it gets into a log.
    if urlsplit(url).password is not None:
        raise InputError(
            "a URL of a recording is written into results, and must not have a password in it: "
            "give it to the store's driver by its own settings"
        )
    # Imported here: the package works without fsspec.
    try:
        url_to_fs = importlib.import_module("fsspec.core").url_to_fs
    except ModuleNotFoundError:
        raise InputError(
            f"the recording {url} is a URL, and to read those the extra [cluster] is needed: "
            "pip install 'vehicle_pf_tracker[cluster]'"
        ) from None
    return _asked(url, lambda: cast("tuple[Any, str]", url_to_fs(url)))


def _asked(url: str, question: Callable[[], AnswerT]) -> AnswerT:
    """Ask the store; it may be of any kind, and fail in any way."""
    try:
        return question()
    except InputError:
        raise
    except ModuleNotFoundError as error:
        raise InputError(f"to read {url} the Python module {error.name} is needed") from error
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"cannot read the recording {url}: {reason}") from error
