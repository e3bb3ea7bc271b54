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

"""The process of the node that follows many vehicles."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_pf_tracker.ros.node.process import run_node_of
from vehicle_pf_tracker.ros.traffic.traffic_node import TrafficNode
from vehicle_pf_tracker.trackers.registry import TRAFFIC


def run_traffic(arguments: Sequence[str]) -> int:
    """Run the node until it is told to end.

    Parameters
    ----------
    arguments : sequence of str
        Command line without the program's name.

    Returns
    -------
    int
        Exit status; see `vehicle_pf_tracker.ros.node.process.run_node`.
    """
    return run_node_of(TRAFFIC.executable, TrafficNode, arguments)
