# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters that a user chooses: a file of them, and values by name over it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.cli.requests import VerbRequest, option
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.parameters.table import Value, unknown_name
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant

# A node's parameter file may be given to `run`, which passes over what is ROS's alone.
_OF_ROS = ("use_sim_time", "start_type_description_service")
_OF_ROS_PREFIX = "qos_overrides."


@dataclass(frozen=True, kw_only=True)
class ParameterOptions(VerbRequest):
    """Request that parameters are chosen in."""

    params: Path | None = option(help="file of parameters, as the verb params prints it")
    assignments: Sequence[str] = option(
        "--set", action="append", default=[], metavar="NAME=VALUE",
        help="set a parameter, over the file; repeatable",
    )  # fmt: skip


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
    return [
        variant.name for variant in VARIANTS.values() if set(names) <= set(kind.of(variant).specs())
    ]
