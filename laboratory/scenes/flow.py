# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Flow of traffic in a scene: its parameters, and where its drivers begin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from laboratory.scenes.driver_model import Driver, Flow, Hold, simulate
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.road.motion import KMH_PER_MS
from vehicle_pf_tracker.scenes.scene import noise_parameter

_FIRST = (0.0, 0.3)
"""Place of each lane's first vehicle in the beginning, of the stretch in the image: traffic comes
in."""
_SPREAD = (0.88, 1.12)
"""Wanted speeds, in mean speeds: without a spread nobody would overtake. A choice."""
_LORRIES_AHEAD = 0.4
"""Place of the first lorry before the first cars, of the stretch, where they overtake."""
_LORRY_GAP = 2.5
"""Mean gap between lorries, in mean gaps: most cars pass one in the image."""
_GAPS = (0.5, 1.5)
"""Shortest and longest gap between two vehicles in the beginning, in mean gaps."""


@dataclass(frozen=True, slots=True)
class TrafficSceneParameters:
    """Parameters of every scene with many vehicles."""

    vehicles: int = parameter(20, "more vehicles in both directions together", bounds=(2, 80))
    directions: int = parameter(2, "1: all drive to the right", bounds=(1, 2))
    lanes: int = parameter(
        3, "more lanes of each direction: more vehicles beside each other", bounds=(1, 4)
    )
    speed: float = parameter(
        55.0, "faster vehicles move farther between two frames",
        bounds=(10.0, 130.0), unit="km/h",
    )  # fmt: skip
    gap: float = parameter(
        18.0, "mean gap in the beginning; shorter ones pack vehicles", bounds=(4.0, 200.0),
        unit="m",
    )  # fmt: skip
    lorries: float = parameter(
        0.1, "share of lorries, which drive in the nearest lane and hide others",
        bounds=(0.0, 1.0),
    )  # fmt: skip
    lorry_speed: float = parameter(
        0.5, "speed of lorries; above 1 they overtake the cars",
        bounds=(0.2, 2.0), unit="of the other vehicles'",
    )  # fmt: skip
    mixed: bool = parameter(False, "lorries drive among the cars, not in a lane of their own")
    bridges: int = parameter(0, "bridges, each of which hides every vehicle once", bounds=(0, 5))
    bridge_width: float = parameter(
        50.0, "wider bridges hide vehicles for longer", bounds=(10.0, 200.0), unit="px"
    )
    flow: str = parameter(
        "free", "queue: a red light holds all for 6 s; waves: short holds again and again",
        choices=("free", "queue", "waves"),
    )  # fmt: skip
    changing: bool = parameter(False, "drivers overtake slower ones")
    frames: int = parameter(400, "a longer scene", bounds=(2, 5000), unit="frames")
    noise: float = noise_parameter(2.0)
    frame_rate: float = parameter(
        30.0, "more frames on the same way", bounds=(5.0, 240.0), unit="frames/s"
    )


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
    """Place the vehicles of one direction one behind the other, and let them drive.

    Parameters
    ----------
    lengths : sequence of float
        Lengths of the vehicles, m.
    is_lorry : sequence of bool
        True for each lorry; where there are any, the last lane is theirs.
    parameters : TrafficSceneParameters
        Settings of the scene.
    visible : float
        Length of the stretch in the image, m; the front of a vehicle at 0 is at its beginning.
    rng : numpy.random.Generator
        Draws speeds and gaps.
    """
    own_lane = any(is_lorry) and parameters.lanes > 1 and not parameters.mixed
    slow = parameters.lanes - 1 if own_lane else parameters.lanes
    # One entry more than lanes: without a lane of lorries `slow` is one that nobody drives in.
    ahead = rng.uniform(*_FIRST, parameters.lanes + 1) * visible
    # Slow lorries begin ahead, so that cars overtake them; fast ones begin behind the cars.
    ahead[slow] += _LORRIES_AHEAD * visible * (1 if parameters.lorry_speed < 1 else -1)
    drivers = []
    car_count = 0
    for length, large in zip(lengths, is_lorry, strict=True):
        alone = large and not parameters.mixed
        # Cars take the lanes in turns, lorries the last one unless they are mixed.
        lane = slow % parameters.lanes if alone else car_count % min(slow, parameters.lanes)
        car_count += not alone
        pace = parameters.lorry_speed if lane == slow or (large and parameters.mixed) else 1.0
        speed = parameters.speed / KMH_PER_MS * rng.uniform(*_SPREAD) * pace
        drivers.append(Driver(lane, float(ahead[lane]), length, float(speed)))
        gap = parameters.gap * rng.uniform(*_GAPS) * (_LORRY_GAP if lane == slow else 1.0)
        # Each begins behind the one before it in its lane.
        ahead[lane] -= length + gap
    return simulate(
        drivers,
        parameters.lanes,
        parameters.frames,
        parameters.frame_rate,
        _holds(parameters, visible),
        changing=parameters.changing,
    )


def _holds(parameters: TrafficSceneParameters, visible: float) -> tuple[Hold, ...]:
    if parameters.flow == "queue":
        # At three quarters of the stretch: the whole queue is in the image.
        return (Hold(0.75 * visible, 2.0, 8.0),)
    if parameters.flow == "waves":
        # Every 6 s for 2.5 s, which makes waves that travel back against the traffic.
        return tuple(Hold(0.85 * visible, begin, begin + 2.5) for begin in range(1, 200, 6))
    return ()
