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

"""The parameters of a run: a file, then ``--set``, then ``--seed`` and ``--target`` over it."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.requests import VerbRequest, option
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.parameters.table import parse_assignments, specs, unknown_name
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
