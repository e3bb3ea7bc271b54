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

"""Parameters of `traffic`."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import parameter


@dataclass(frozen=True, slots=True)
class TrafficParameters:
    """Parameters of `traffic`."""

    seed: int = parameter(
        0,
        "Seed of everything random; -1: another one in each run, which is reported.",
        minimum=-1,
        maximum=2**31 - 1,
        effect="restarts",
    )
    num_particles: int = parameter(
        50,
        "More: steadier where pixels alone hold a vehicle, at more time per frame.",
        minimum=10,
        maximum=10_000,
    )
    lost_after: float = parameter(
        2.0,
        "Longer: a hidden vehicle is predicted for longer before it is LOST.",
        minimum=0.0,
        maximum=60.0,
        unit="s",
    )
    forgotten_after: float = parameter(
        3.0,
        "Longer: a LOST vehicle can come back under its number for longer.",
        minimum=0.0,
        maximum=600.0,
        unit="s",
    )
