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

"""Settings of the scenes with many vehicles."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import parameter


@dataclass(frozen=True, slots=True)
class TrafficSceneParameters:
    """Parameters of every scene with many vehicles."""

    vehicles: int = parameter(
        20, "more vehicles in both directions together", minimum=2, maximum=80
    )
    directions: int = parameter(2, "1: all drive to the right", minimum=1, maximum=2)
    lanes: int = parameter(
        3, "more lanes of each direction: more vehicles beside each other", minimum=1, maximum=4
    )
    speed: float = parameter(
        55.0, "faster vehicles move farther between two frames",
        minimum=10.0, maximum=130.0, unit="km/h",
    )  # fmt: skip
    gap: float = parameter(
        18.0, "mean gap in the beginning; shorter ones pack vehicles", minimum=4.0, maximum=200.0,
        unit="m",
    )  # fmt: skip
    lorries: float = parameter(
        0.1,
        "share of lorries, which drive in the nearest lane and hide others",
        minimum=0.0,
        maximum=1.0,
    )
    lorry_speed: float = parameter(
        0.5,
        "speed of lorries; above 1 they overtake the cars",
        minimum=0.2,
        maximum=2.0,
        unit="of the other vehicles'",
    )
    mixed: bool = parameter(False, "lorries drive among the cars, not in a lane of their own")
    view: str = parameter(
        "side",
        "gantry: in perspective from over the road, the last lane is the outer one; mast: from "
        "the middle of the road, the last lane is the inner one",
        choices=("side", "gantry", "mast"),
    )
    bridges: int = parameter(
        0,
        "bridges, each of which hides every vehicle once; in the view from the side",
        minimum=0,
        maximum=5,
    )
    bridge_width: float = parameter(
        50.0, "wider bridges hide vehicles for longer", minimum=10.0, maximum=200.0, unit="px"
    )
    flow: str = parameter(
        "free", "queue: a red light holds all for 6 s; waves: short holds again and again",
        choices=("free", "queue", "waves"),
    )  # fmt: skip
    changing: bool = parameter(False, "drivers overtake slower ones")
    frames: int = parameter(400, "a longer scene", minimum=2, maximum=5000, unit="frames")
    noise: float = parameter(
        2.0, "more makes histograms differ from frame to frame",
        minimum=0.0, maximum=60.0, unit="levels of 255",
    )  # fmt: skip
    frame_rate: float = parameter(
        30.0, "more frames on the same way", minimum=5.0, maximum=240.0, unit="frames/s"
    )
