# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Options of the verbs that track: where they start from, and what they are to show."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.cli.requests import OverwriteOption, SourceOptions, VerbRequest, option
from vehicle_pf_tracker.cli.source_part import Moment
from vehicle_pf_tracker.cli.target_options import (
    TARGET_FORM,
    TargetOption,
    parse_target,
    read_list,
    target_of,
)
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration, SessionParameters
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.parameters.table import Value, parse_assignments, specs, unknown_name
from vehicle_pf_tracker.showing.page_server import LOCAL_ADDRESS
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant

# A node's parameter file may be given to `run`, which passes over what is ROS's alone.
_OF_ROS = ("use_sim_time", "start_type_description_service")
_OF_ROS_PREFIX = "qos_overrides."
_LAST_PORT = 65535
"""Largest number of a port: they have 16 bits."""


@dataclass(frozen=True, kw_only=True)
class StartOptions(VerbRequest):
    """Options that choose parameters to start from."""

    params: Path | None = option(help="file of parameters, as the verb params prints it")
    assignments: Sequence[str] = option(
        "--set", action="append", default=[], metavar="NAME=VALUE",
        help="set a parameter, over the file; repeatable",
    )  # fmt: skip


def chosen(variant: Variant, request: TrackingRequest) -> Configuration:
    """Collect the parameters that a request chooses.

    Raises
    ------
    InputError
        If the file cannot be used, or a name or a value does not fit.
    """
    # Those of the node alone would change nothing here, so they are refused as unknown.
    table = {**specs(variant.parameters), **specs(SessionParameters)}
    values = parse_assignments(table, request.assignments)
    seed = {} if request.seed is None else {"seed": request.seed}
    return configure(variant, [request.params] if request.params else [], {**values, **seed})


def configure(
    variant: Variant, files: Iterable[Path], values: Mapping[str, Value]
) -> Configuration:
    """Put files, and then values by name, over a variant's defaults.

    Raises
    ------
    InputError
        If a file, a name or a value does not fit.
    """
    configuration = Configuration.of(variant)
    for file in files:
        configuration = with_file(configuration, variant, file)
    return configuration.updated(values)


def with_file(configuration: Configuration, variant: Variant, path: Path) -> Configuration:
    """Put the parameters that a file has for the node of `variant` over a configuration.

    Raises
    ------
    InputError
        If the file cannot be used, or a name or a value does not fit.
    """
    values = read_yaml(path, f"{variant.name}_tracker")
    known = configuration.specs()
    own = [name for name in values if name not in _OF_ROS and not name.startswith(_OF_ROS_PREFIX)]
    problems = [unknown_name(name, known) for name in own if name not in known]
    if problems and (others := _variants_with(own, type(configuration))):
        problems = [problems[0], f"it is a file for {', '.join(others)}"]
    try:
        configuration = configuration.updated(values)
    except InputError as error:
        problems.append(str(error))
    if problems:
        raise InputError(f"the parameter file {path}: {'; '.join(problems)}")
    return configuration


def _variants_with(names: Iterable[str], kind: type[Configuration]) -> list[str]:
    """Return the variants that have all these parameters."""
    return [one.name for one in VARIANTS.values() if set(names) <= set(kind.of(one).specs())]


@dataclass(frozen=True, slots=True)
class ServeAddress:
    """Address at which a page is served.

    Attributes
    ----------
    port : int
        Port; 0 for any free one.
    host : str
        Address to listen at.
    """

    port: int = 0
    host: str = LOCAL_ADDRESS

    @classmethod
    def parse(cls, text: str) -> ServeAddress:
        """Read ``8080``, ``0.0.0.0:8080`` or ``[::]:8080``.

        Raises
        ------
        InputError
            If it is none of them.
        """
        host, _, port = text.rpartition(":")
        if not (port.isascii() and port.isdecimal() and int(port) <= _LAST_PORT):
            raise InputError(f"{text!r} is not [HOST:]PORT, with a port from 0 to {_LAST_PORT}")
        return cls(int(port), host.strip("[]") or LOCAL_ADDRESS)


def parse_token(text: str) -> str:
    """Read the secret part of an address.

    Raises
    ------
    InputError
        If it is short, or has letters that an address cannot have as they are.
    """
    if not re.fullmatch(r"[A-Za-z0-9_-]{8,100}", text):
        raise InputError("a token has 8 to 100 letters, digits, - and _")
    return text


@dataclass(frozen=True, kw_only=True)
class TrackingRequest(SourceOptions, StartOptions, OverwriteOption):
    """Request to track in a source, or in a part of it."""

    seed: int | None = option(help="seed of the random numbers; -1 draws one and run.json keeps it")
    start: Moment | None = option(
        type=Moment.parse, metavar="AT",
        help="first frame: its number, from 1, or its time in seconds, as 4.3s",
    )  # fmt: skip
    end: Moment | None = option(type=Moment.parse, metavar="AT", help="last frame, likewise")
    target: Sequence[TargetOption] = option(
        type=parse_target, action="append", default=[], metavar="[NAME][@FRAME:]X,Y,W,H",
        help="vehicle to follow: top-left corner and size of its box in px, in the first frame or "
        "in FRAME; repeatable, for several vehicles or to correct one later; run starts on the "
        "first true box otherwise, and traffic follows these beside those that it detects",
    )  # fmt: skip
    targets: Path | None = option(help="targets that `pick` wrote")
    video: Path | None = option(help="write the frames with all that is followed to FILE, an mp4")
    serve: ServeAddress | None = option(
        type=ServeAddress.parse, nargs="?", const=ServeAddress(), metavar="[HOST:]PORT",
        help="show picture and numbers meanwhile on a page for this machine's browsers; without "
        "PORT at any free one, with 0.0.0.0:PORT for other machines, in clear text",
    )  # fmt: skip
    token: str | None = option(
        type=parse_token, metavar="WORD",
        help="secret part of the page's address, instead of a random one",
    )  # fmt: skip

    @property
    def inputs(self) -> tuple[str | Path | None, ...]:
        """The source, and the files that options name."""
        return self.source, self.params, self.targets

    def given_targets(self) -> list[TargetOption]:
        """Collect the targets of the command line and of the file."""
        of_file = read_list(self.targets, "targets", TARGET_FORM, target_of) if self.targets else []
        return [*self.target, *of_file]
