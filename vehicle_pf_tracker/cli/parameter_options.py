# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The parameters of a run: a file, then ``--set``, then ``--seed`` and ``--target`` over it.

Parameter sets of an evaluation: files and values under a name, beside the defaults.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.requests import VerbRequest, option
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.parameters.table import (
    ParameterSpec,
    parse_assignments,
    specs,
    unknown_name,
)
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant

if TYPE_CHECKING:
    from vehicle_pf_tracker.parameters.configuration import Configuration

_OF_ROS = ("use_sim_time", "start_type_description_service")
_OF_ROS_PREFIX = "qos_overrides."


@dataclass(frozen=True, kw_only=True)
class ParameterOptions(VerbRequest):
    """Options that choose parameters."""

    params: Path | None = option(
        type=Path, metavar="FILE", help="ROS parameter file, as `params` prints it"
    )
    assignments: Sequence[str] = option(
        "--set", action="append", default=[], metavar="NAME=VALUE",
        help="set a parameter, over the file; repeatable",
    )  # fmt: skip
    seed: int | None = option(
        type=int, help="seed of the random numbers; -1 draws one and run.json keeps it"
    )


def parse_box(text: str) -> Box:
    """Read ``x,y,w,h`` of a command line."""
    try:
        x, y, width, height = map(float, text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not x,y,w,h in px") from None
    if not all(map(math.isfinite, (x, y, width, height))):
        raise argparse.ArgumentTypeError(f"{text!r} has a number that is not finite")
    return Box(x, y, width, height)


def chosen(variant: Variant, request: ParameterOptions) -> Configuration:
    """Collect the parameters that a request chooses.

    Raises
    ------
    InputError
        If the file cannot be used, or a name or a value does not fit.
    """
    from vehicle_pf_tracker.parameters.configuration import Configuration

    configuration = Configuration.of(variant)
    if request.params is not None:
        configuration = with_file(configuration, variant, request.params)
    # Those of the node alone would change nothing here, so they are refused as unknown.
    table = {**specs(variant.parameters), **specs(type(configuration.session))}
    configuration = configuration.updated(parse_assignments(table, request.assignments))
    if request.seed is not None:
        configuration = configuration.updated({"seed": request.seed})
    return configuration


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
        problems.append(f"it is a file for {', '.join(others)}")
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


@dataclass(frozen=True)
class ParameterSet:
    """Named parameters; for one variant, or (None) for all that accept them."""

    name: str
    variant: str | None = None
    files: list[Path] = field(default_factory=list)
    assignments: list[str] = field(default_factory=list)


def read_sets(
    files: Iterable[str], assignments: Iterable[str]
) -> tuple[list[str], list[ParameterSet]]:
    """Return the assignments that hold everywhere, and the sets in the order they are named.

    Parameters
    ----------
    files : iterable of str
        Each ``LABEL=FILE`` or ``VARIANT@LABEL=FILE``.
    assignments : iterable of str
        Each ``NAME=VALUE``, with ``LABEL:`` or ``VARIANT@LABEL:`` before it if it is for a set.

    Raises
    ------
    UsageError
        If one is malformed.
    """
    everywhere: list[str] = []
    sets: dict[str, ParameterSet] = {}

    def named(label: str) -> ParameterSet:
        variant, at, name = label.rpartition("@")
        if not name or (at and not variant):
            raise UsageError(
                f"{label!r} is not a label of a parameter set: give LABEL or VARIANT@LABEL"
            )
        return sets.setdefault(label, ParameterSet(name, variant or None))

    for word in files:
        label, equals, file = word.partition("=")
        if not (equals and file):
            raise UsageError(f"--params expects LABEL=FILE, not {word!r}")
        named(label).files.append(Path(file))
    for word in assignments:
        label = word.partition("=")[0].rpartition(":")[0]
        if label:
            named(label).assignments.append(word[len(label) + 1 :])
        else:
            everywhere.append(word)
    return everywhere, list(sets.values())


def check_sets(
    variants: Sequence[Variant], everywhere: Iterable[str], sets: Iterable[ParameterSet]
) -> None:
    """Check that sets and assignments are for `variants`.

    Raises
    ------
    InputError
        If one is for none of them.
    """
    names = [variant.name for variant in variants]
    for each in sets:
        if not names:
            raise InputError(
                f"the parameter set {each.name} is for no variant: there are only baselines"
            )
        if each.variant is not None and each.variant not in names:
            raise InputError(
                f"the parameter set {each.variant}@{each.name} is for a variant that is not among "
                f"--variants {','.join(names)}"
            )
    known = {name for variant in variants for name in settable(variant)}
    for word in everywhere:
        name = word.partition("=")[0]
        if name not in known:
            raise InputError(unknown_name(name, known))


def fitting_sets(
    variants: Sequence[Variant], sets: Iterable[ParameterSet]
) -> tuple[dict[str, list[ParameterSet]], list[str]]:
    """Return the sets that each variant can run with, and notes on those that it cannot.

    Raises
    ------
    InputError
        If a set fits no variant.
    """
    fitting: dict[str, list[ParameterSet]] = {variant.name: [] for variant in variants}
    notes = []
    for each in sets:
        named = [variant for variant in variants if each.variant in {None, variant.name}]
        misfits = {variant.name: _misfit(variant, each) for variant in named}
        reasons = [reason for reason in misfits.values() if reason]
        if len(reasons) == len(named):
            raise InputError(reasons[0])
        notes += reasons
        for name, reason in misfits.items():
            fitting[name] += [] if reason else [each]
    return fitting, notes


def configure(variant: Variant, parameter_set: ParameterSet) -> Configuration:
    """Put a set over a variant's defaults.

    Raises
    ------
    InputError
        If a file, a name or a value does not fit.
    """
    from vehicle_pf_tracker.parameters.configuration import Configuration

    configuration = Configuration.of(variant)
    for file in parameter_set.files:
        configuration = with_file(configuration, variant, file)
    values = parse_assignments(settable(variant), parameter_set.assignments)
    return configuration.updated(values)


def settable(variant: Variant) -> dict[str, ParameterSpec]:
    """Return the parameters that may differ between systems: neither seed nor target."""
    table = {**specs(variant.parameters), **specs(SessionParameters)}
    return {n: s for n, s in table.items() if n != "seed" and not n.startswith("target.")}


def _misfit(variant: Variant, parameter_set: ParameterSet) -> str:
    """Say why a variant cannot run with a set; empty if it can."""
    try:
        configure(variant, parameter_set)
    except InputError as error:
        return f"{variant.name} is not run with {parameter_set.name}: {error}"
    return ""
