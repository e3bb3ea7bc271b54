# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests: frozen objects that say what a user asks of a verb, made of its command line.

A field declares the option that it is read from; `option_values` reads what stands behind it.
"""

from __future__ import annotations

import argparse
import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, TypeVar

from vehicle_pf_tracker.core.errors import InputError


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
    for declared in filter(lambda each: each.metadata, fields(kind)):
        settings = _KINDS.get(str(declared.type).removesuffix(" | None"), {})
        settings = {**settings, **declared.metadata["settings"]}
        if "type" in settings:
            settings["type"] = _telling_why(settings["type"])
        flags = declared.metadata.get("flags")
        if flags is None:
            parser.add_argument(declared.name, **settings)
            continue
        if not any(flag.startswith("--") for flag in flags):
            flags = (*flags, f"--{declared.name.replace('_', '-')}")
        if only_given:
            settings["default"] = argparse.SUPPRESS
        parser.add_argument(*flags, dest=declared.name, **settings)


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
    values = {declared.name: getattr(args, declared.name) for declared in fields(kind)}
    return kind(**{name: tuple(v) if isinstance(v, list) else v for name, v in values.items()})
