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

"""Drivers of a scene with many vehicles, and what holds them up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.scenes.flow import Driver, Flow, Hold, simulate
from vehicle_pf_tracker.scenes.traffic_settings import TrafficSceneParameters

_KMH = 3.6
"""km/h in a m/s."""
_FIRST = (0.0, 0.3)
"""Place of each lane's first vehicle in the beginning, of the stretch in the image: traffic comes
in."""
_SPREAD = (0.88, 1.12)
"""Wanted speeds, in mean speeds."""
_LORRIES_AHEAD = 0.4
"""Place of the first lorry before the first cars, of the stretch, where they overtake."""
_LORRY_GAP = 2.5
"""Mean gap between lorries, in mean gaps: most cars pass one in the image."""
_GAPS = (0.5, 1.5)
"""Shortest and longest gap between two vehicles in the beginning, in mean gaps."""


def draw_lorries(
    count: int, parameters: TrafficSceneParameters, rng: np.random.Generator
) -> list[bool]:
    """Draw which of the vehicles of one direction are lorries."""
    lorries = np.arange(count) < round(parameters.lorries * count)
    chosen: npt.NDArray[np.bool_] = rng.permutation(lorries)
    return list(map(bool, chosen))


def drive(
    lengths: Sequence[float],
    is_lorry: Sequence[bool],
    parameters: TrafficSceneParameters,
    visible: float,
    rng: np.random.Generator,
) -> Flow:
    """Simulate the vehicles of one direction.

    Parameters
    ----------
    lengths : sequence of float
        Of the vehicles, m.
    is_lorry : sequence of bool
        Which of them are lorries; where there are any, the last lane is theirs.
    parameters : TrafficSceneParameters
        Settings of the scene.
    visible : float
        Length of the stretch in the image, m; the front of a vehicle at 0 is at its beginning.
    rng : numpy.random.Generator
        Draws speeds and gaps.
    """
    return simulate(
        _drivers(lengths, is_lorry, parameters, visible, rng),
        parameters.lanes,
        parameters.frames,
        parameters.frame_rate,
        _holds(parameters, visible),
        changing=parameters.changing,
    )


def _drivers(
    lengths: Sequence[float],
    is_lorry: Sequence[bool],
    parameters: TrafficSceneParameters,
    visible: float,
    rng: np.random.Generator,
) -> list[Driver]:
    """Place vehicles one behind the other."""
    own_lane = any(is_lorry) and parameters.lanes > 1 and not parameters.mixed
    slow = parameters.lanes - 1 if own_lane else parameters.lanes
    ahead = rng.uniform(*_FIRST, parameters.lanes + 1) * visible
    ahead[slow] += _LORRIES_AHEAD * visible * (1 if parameters.lorry_speed < 1 else -1)
    drivers, car_count = [], 0
    for length, large in zip(lengths, is_lorry, strict=True):
        alone = large and not parameters.mixed
        lane = slow % parameters.lanes if alone else car_count % min(slow, parameters.lanes)
        car_count += not alone
        pace = parameters.lorry_speed if lane == slow or (large and parameters.mixed) else 1.0
        speed = parameters.speed / _KMH * rng.uniform(*_SPREAD) * pace
        drivers.append(Driver(lane, float(ahead[lane]), length, float(speed)))
        gap = parameters.gap * rng.uniform(*_GAPS) * (_LORRY_GAP if lane == slow else 1.0)
        ahead[lane] -= length + gap
    return drivers


def _holds(parameters: TrafficSceneParameters, visible: float) -> tuple[Hold, ...]:
    if parameters.flow == "queue":
        return (Hold(0.75 * visible, 2.0, 8.0),)
    if parameters.flow == "waves":
        return tuple(Hold(0.85 * visible, begin, begin + 2.5) for begin in range(1, 200, 6))
    return ()
