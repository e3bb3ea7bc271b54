# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`params`: the default parameters of a variant, as a ROS parameter file."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.cli.option_values import NameChoices
from vehicle_pf_tracker.cli.requests import VerbRequest, positional
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.trackers.registry import NODES, Variant, find_node


@dataclass(frozen=True, kw_only=True)
class Request(VerbRequest):
    """Request of `params`."""

    variant: str = positional(choices=NameChoices(NODES), metavar="VARIANT", help=", ".join(NODES))


def run(request: Request) -> int:
    """Print the parameters."""
    print(default_yaml(find_node(request.variant)), end="")
    return 0


def default_yaml(variant: Variant) -> str:
    """Write the defaults of the node of `variant` as a commented ROS parameter file."""
    defaults = Configuration.of(variant)
    title = f"{variant.name}: {variant.summary}. Printed by `vehicle-pf-tracker params`."
    return to_yaml(defaults.specs(), defaults.to_mapping(), title)
