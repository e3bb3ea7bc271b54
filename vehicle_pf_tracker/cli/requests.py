# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests: frozen objects that say what a user asks of a verb, made of its command line."""

from __future__ import annotations

import argparse
import functools
import math
import os
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S
from vehicle_pf_tracker.core.errors import InputError, suggestion

if TYPE_CHECKING:
    from vehicle_pf_tracker.recordings.source import ImageSource


@dataclass(frozen=True, kw_only=True)
class VerbRequest:
    """Base of the requests: its subclasses declare each option of a verb as a field.

    Attributes
    ----------
    command : sequence of str
        The whole command line.
    """

    command: Sequence[str]


RequestT = TypeVar("RequestT", bound=VerbRequest)


def option(*flags: str, **settings: Any) -> Any:
    """Declare the option that a field is read from.

    Parameters
    ----------
    flags : str
        Words of the option; ``--`` with the field's name is added where none begins with ``--``.
    settings
        Keywords of `argparse.ArgumentParser.add_argument`; `type` may raise an `InputError`.
    """
    return field(metadata={"flags": flags, "settings": settings})


def switch(*flags: str, help: str) -> Any:  # noqa: A002 - as in argparse
    """Declare the option without a value that makes a field true."""
    return option(*flags, action="store_true", help=help)


class NameChoices(tuple[str, ...]):
    """Choices that a shell completes; other names are left to the verb, which says more of them."""

    __slots__ = ()

    def __contains__(self, name: object) -> bool:
        """Let argparse take every name."""
        return True


def positional(**settings: Any) -> Any:
    """Declare the argument without a flag that a field is read from."""
    return field(metadata={"settings": settings})


_KINDS: Mapping[str, Mapping[str, Any]] = {
    "Path": {"type": Path, "metavar": "FILE"},
    "int": {"type": int},
    "float": {"type": float},
}
"""Settings that follow from a field's type, where it does not say others."""


def add_options(
    parser: argparse.ArgumentParser, kind: type[VerbRequest], *, only_given: bool = False
) -> None:
    """Add the options that the fields of a request are read from.

    Parameters
    ----------
    parser : argparse.ArgumentParser
        Where they are added.
    kind : type
        Class of the request.
    only_given : bool
        True to parse only what is given, without defaults.
    """
    for one in filter(lambda one: one.metadata, fields(kind)):
        settings = _KINDS.get(str(one.type).removesuffix(" | None"), {})
        settings = {**settings, **one.metadata["settings"]}
        if "type" in settings:
            settings["type"] = _telling_why(settings["type"])
        flags = one.metadata.get("flags")
        if flags is None:
            parser.add_argument(one.name, **settings)
            continue
        if not any(flag.startswith("--") for flag in flags):
            flags = (*flags, f"--{one.name.replace('_', '-')}")
        if only_given:
            settings["default"] = argparse.SUPPRESS
        parser.add_argument(*flags, dest=one.name, **settings)


def _telling_why(read: Callable[[str], Any]) -> Callable[[str], Any]:
    """Let argparse print the sentence of an `InputError`."""

    @functools.wraps(read)
    def read_or_tell(text: str) -> Any:
        try:
            return read(text)
        except InputError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return read_or_tell


def request_of(kind: type[RequestT], args: argparse.Namespace) -> RequestT:
    """Make a request of a parsed command line."""
    values = {one.name: getattr(args, one.name) for one in fields(kind)}
    return kind(**{name: tuple(v) if isinstance(v, list) else v for name, v in values.items()})


def names_in(text: str, known: Collection[str], what: str) -> tuple[str, ...]:
    """Read names apart by commas, each of which has to be among the known ones."""
    names = tuple(dict.fromkeys(text.split(",")))
    for name in names:
        if name not in known:
            choice = f"{suggestion(name, known)}; choose from {', '.join(sorted(known))}"
            raise InputError(f"{name!r} is not {what}{choice}")
    return names


def _at_least(least: int, text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) < least:
        raise InputError(f"{text!r} is not an integer >= {least}")
    return int(text)


positive = functools.partial(_at_least, 1)
"""Read an integer >= 1."""
natural = functools.partial(_at_least, 0)
"""Read an integer >= 0."""


def positive_number(text: str) -> float:
    """Read a finite number above 0."""
    value = number(text)
    if value <= 0:
        raise InputError(f"{text} is not more than 0")
    return value


def number(text: str) -> float:
    """Read a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{text!r} is not a number")
    return value


@dataclass(frozen=True, kw_only=True)
class OverwriteOption(VerbRequest):
    """Request that can replace outputs."""

    overwrite: bool = switch(help="replace outputs that exist")


@dataclass(frozen=True, kw_only=True)
class MaxDiffOption(VerbRequest):
    """Request that associates estimates and truth."""

    max_diff: float = option(
        default=PAIRED_WITHIN_S, metavar="S",
        help=f"largest time between an image and its truth (default: {PAIRED_WITHIN_S:g} s)",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class RosOptions(VerbRequest):
    """Request that talks to nodes."""

    timeout: float = option(
        type=positive_number, default=10.0, metavar="S",
        help="longest wait for a node in seconds (default: 10)",
    )  # fmt: skip
    ros_args: Sequence[str] = option(
        nargs=argparse.REMAINDER, default=[], metavar="...", help="all words after this go to ROS"
    )


@dataclass(frozen=True, kw_only=True)
class TopicOption(VerbRequest):
    """Request that reads recordings."""

    topic: str | None = option(help="topic of the images, where a recording has several")


@dataclass(frozen=True, kw_only=True)
class SourceOptions(TopicOption):
    """Request that reads images of any source."""

    source: str = positional(
        metavar="SOURCE",
        help="recording, video file, folder of images, number of a camera (0, 1), or URL of a "
        "stream",
    )  # fmt: skip
    fps: float | None = option(
        metavar="HZ", help="frame rate, instead of the one that SOURCE states"
    )

    def open_source(self) -> ImageSource:
        """Open the source; the truth beside its images is not read."""
        from vehicle_pf_tracker.recordings.source import open_source
        from vehicle_pf_tracker.recordings.truth.files import Beside

        return open_source(self.source, topic=self.topic, fps=self.fps, beside=Beside.IGNORED)


@dataclass(frozen=True, kw_only=True)
class IdOption(VerbRequest):
    """Request that reads truth of several targets."""

    id: int | None = option(metavar="N", help="number of the vehicle, where the truth has several")


@dataclass(frozen=True, kw_only=True)
class TruthOptions(IdOption):
    """Request that reads the truth of videos and folders."""

    truth: Path | None = option(
        help="truth of a video or a folder (default: what lies beside a folder's images); "
        "docs/evaluation.md lists the formats",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class WorkersOption(VerbRequest):
    """Request for work in several processes."""

    workers: int = option(
        type=positive, default=os.cpu_count() or 1, metavar="N",
        help="processes; results do not depend on it (default: one per processor)",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class SchedulerOption(WorkersOption):
    """Request for work in processes here, or on the machines of a cluster."""

    scheduler: str | None = option(
        metavar="tcp://HOST:8786",
        help="run on the workers of this Dask scheduler instead; docs/scale.md",
    )  # fmt: skip
