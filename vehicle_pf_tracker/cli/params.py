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

"""`params`: the default parameters of a variant, as a ROS parameter file."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.cli.requests import Names, VerbRequest, positional
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.trackers.registry import NODES, Variant, find_node


@dataclass(frozen=True, kw_only=True)
class Request(VerbRequest):
    """Request of `params`."""

    variant: str = positional(choices=Names(NODES), metavar="VARIANT", help=", ".join(NODES))


def run(request: Request) -> int:
    """Print the parameters."""
    print(default_yaml(find_node(request.variant)), end="")
    return 0


def default_yaml(variant: Variant) -> str:
    """Write the defaults of the node of `variant` as a commented ROS parameter file."""
    defaults = Configuration.of(variant)
    title = f"{variant.name}: {variant.summary}. Printed by `vehicle-pf-tracker params`."
    return to_yaml(defaults.specs(), defaults.to_mapping(), title)
