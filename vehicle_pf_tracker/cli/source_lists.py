# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The sources of one command: arguments, patterns of paths, and lists.

A list has a source a line, with options of its own, as on the command line.
"""

from __future__ import annotations

import argparse
import glob
import os
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.requests import VerbRequest, add_options, option, positional
from vehicle_pf_tracker.cli.shared_options import SchedulerOption
from vehicle_pf_tracker.cli.tracking_options import TrackingRequest
from vehicle_pf_tracker.core.addresses import short_name
from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.recordings.recording_names import is_url

LIST = ".txt"
"""Ending of a list; no source has it."""
OUTPUT_OPTIONS = ("video", "recording", "tum")
"""Options that name an output: with several sources, a name in each one's folder."""
NOT_DECISIVE = {
    "command",
    "source",
    "more",
    "output",
    "overwrite",
    "workers",
    "scheduler",
    "serve",
    "token",
}
"""Options that change no result, and the source, which the key has otherwise."""


@dataclass(frozen=True, kw_only=True)
class SeveralSources(TrackingRequest, SchedulerOption):
    """Request to track in one source, or in each of several."""

    more: Sequence[str] = positional(
        metavar="MORE", nargs="*",
        help="more sources; they and SOURCE may be patterns as 'cams/*.mp4', and lists, FILE.txt "
        "with a source a line and its own options: -o then has a folder for each and sources.csv "
        "over all, and the same command continues; docs/scale.md",
    )  # fmt: skip
    output: Path | None = option("-o", metavar="DIR", help="folder of the results")

    @property
    def is_of_several(self) -> bool:
        """True where the results are those of several sources, each in a folder of its own."""
        has_list = any(
            _is_pattern(word) or word.endswith(LIST) for word in (self.source, *self.more)
        )
        return bool(self.more) or has_list or self.scheduler is not None


RequestT = TypeVar("RequestT", bound=SeveralSources)


def requests_by_name(request: RequestT) -> dict[str, RequestT]:
    """Return a request for each source by its name, patterns and lists expanded, paths absolute.

    Raises
    ------
    InputError
        If a list cannot be used, a pattern fits nothing, or two sources have one name.
    UsageError
        If a source is a camera, which has no end.
    """
    requests: list[RequestT] = []
    for word in (request.source, *request.more):
        own = replace(request, source=word, more=())
        if word.endswith(LIST):
            requests += [replace(own, **changed) for changed in _read_list(Path(word), own)]
        else:
            requests += [replace(own, source=path) for path in _spread(word)]
    return _named([_absolute(own) for own in requests])


def _is_pattern(source: str) -> bool:
    return glob.has_magic(source) and not is_url(source) and not os.path.exists(source)  # noqa: PTH110


def _spread(source: str) -> list[str]:
    if not _is_pattern(source):
        return [source]
    paths = sorted(glob.glob(source))  # noqa: PTH207 - of a whole path
    if not paths:
        raise InputError(f"no source is called as {source}")
    return paths


def _absolute(request: RequestT) -> RequestT:
    """Name files by absolute paths, as workers may run in other folders."""
    if request.source.isdecimal() and not Path(request.source).exists():
        raise UsageError(f"the camera {request.source} has no end; give it a command of its own")
    names = [
        declared.name
        for declared in fields(request)
        if declared.name not in {*NOT_DECISIVE, *OUTPUT_OPTIONS}
    ]
    values = {"source": request.source, **{name: getattr(request, name) for name in names}}
    files = {name: value for name, value in values.items() if _is_file_name(name, value)}
    return replace(request, **{name: type(at)(Path(at).absolute()) for name, at in files.items()})


def _is_file_name(name: str, value: Any) -> bool:
    if name == "source":
        return not is_url(value)
    # A network is a file, a known name or a URL.
    return isinstance(value, Path) or (name == "model" and bool(value) and Path(value).is_file())


def _named(requests: Sequence[RequestT]) -> dict[str, RequestT]:
    """Name sources by their last part, or with the folder before where those are not distinct."""
    for name_of in (short_name, _longer_name):
        named = {name_of(request.source): request for request in requests}
        if len(named) == len(requests):
            return named
    names = [_longer_name(request.source) for request in requests]
    twice = next(name for name in names if names.count(name) > 1)
    raise InputError(f"several sources would be called {twice}; rename one, or give it once")


def _longer_name(source: str) -> str:
    above = short_name(source.rstrip("/").rpartition("/")[0])
    return f"{above}-{short_name(source)}"


class _Parser(argparse.ArgumentParser):
    """Parser of a line, whose mistakes are errors of the list."""

    def error(self, message: str) -> NoReturn:
        raise InputError(message)


def _read_list(path: Path, request: VerbRequest) -> list[dict[str, Any]]:
    """Read for each line of a list what it changes in a request of one source.

    Paths are relative to the folder of the list. What follows a ``#`` says nothing.

    Raises
    ------
    InputError
        If it cannot be read, has no source, or a line is not as on the command line.
    """
    parser = _Parser(add_help=False, allow_abbrev=False)
    # Not by comparing with defaults: a line may state one against the command's own option.
    add_options(parser, type(request), only_given=True)
    entries = []
    for number, line in enumerate(read_text(path, "the list of sources").splitlines(), start=1):
        try:
            words = shlex.split(line, comments=True)
            values = vars(parser.parse_args(words)) if words else None
        except (InputError, ValueError) as error:
            raise InputError(f"line {number} of {path}: {error}") from None
        if values is None:
            continue
        if values.pop("more"):
            raise InputError(f"line {number} of {path} has more than one source")
        entries.append({name: _at(path.parent, name, value) for name, value in values.items()})
    if not entries:
        raise InputError(f"the list {path} names no source")
    return entries


def _at(folder: Path, name: str, value: Any) -> Any:
    """Return a value of a line, as a request has it."""
    if name == "source":
        return value if is_url(value) else str(folder / value)
    if isinstance(value, Path):
        return folder / value
    return tuple(value) if isinstance(value, list) else value
