# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The highway: a target in the far slow lane of a dual carriageway, among traffic.

A bridge hides it for about 22 frames, and later a lorry in the next lane for about 24; each comes
and goes over 10 to 15 frames of partial occlusion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.courses import (
    Wave,
    moving,
    swaying,
    wave,
)
from vehicle_pf_tracker.scenes.lane_traffic import (
    FAR_LANES,
    NEAR_LANES,
    LaneVehicle,
    Stage,
    any_car,
    convoy,
)
from vehicle_pf_tracker.scenes.obstacles import bridge
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.roads import dual_carriageway
from vehicle_pf_tracker.scenes.scene import Actor, Scene, noise_parameter, stamps_parameter
from vehicle_pf_tracker.scenes.vehicles import car, lorry, saloon

WIDTH = 640
"""Width of the image, px: that of the papers' videos."""
HEIGHT = 480
"""Height of the image, px: that of the papers' videos."""
FRAME_COUNT = 200
"""Number of frames: room for both occlusions, with 30 clear frames before and between them."""
STAGE = Stage(FRAME_COUNT, WIDTH)
"""Number of frames and width of the scene."""
START_PX = 33
"""Start of the target's middle, px from the left: half of its 46 px, and 10 px free."""
SPEED = 2.9
"""Mean speed of the target, px/frame: it crosses the image in `FRAME_COUNT` frames."""
OVERTAKING = 3.8
"""Mean speed of the lorry over the target's, px/frame."""
HIDDEN_AT = 133
"""Frame in which the middle of the lorry's box is level with the target."""
LOAD_MIDDLE = 0.39
"""Middle of the lorry's box, as a share of its length: 8.3 / 2 of 10.6 m."""


@dataclass(frozen=True, slots=True)
class HighwayParameters:
    """Parameters of the highway."""

    noise: float = noise_parameter(3.0)
    frame_rate: float = stamps_parameter(30.0, "speeds are")


def highway(parameters: HighwayParameters, seed: int) -> Scene:
    """Make the scene."""
    rng = stream(seed, "traffic")
    slow_lane = _slow_lane(rng)
    # In painting order, far to near: the bridge is above all lanes, and so comes last.
    actors = [
        *slow_lane,
        *_middle_lane(rng),
        *convoy(FAR_LANES[2], rng.uniform(7.2, 8.4), STAGE, rng),
        *(
            actor
            for lane, speed in zip(NEAR_LANES, (9.5, 7.8, 6.2), strict=True)
            for actor in convoy(lane, speed * rng.uniform(0.93, 1.07), STAGE, rng)
        ),
        *bridge(150 + rng.uniform(-4, 4), 100, HEIGHT, stream(seed, "bridge")),
    ]
    return Scene(
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=FRAME_COUNT,
        backdrop=lambda: dual_carriageway(WIDTH, HEIGHT, stream(seed, "backdrop")),
        actors=tuple(actors),
        target=len(slow_lane) - 1,
        camera=Camera(parameters.noise, seed),
    )


def _slow_lane(rng: np.random.Generator) -> list[Actor]:
    """Make a saloon of a similar blue, a car well behind it, and between them, last, the target."""
    lane = FAR_LANES[0]
    hatchback = LaneVehicle(car((38, 92, 168)), lane)
    start = hatchback.box(START_PX - hatchback.size[0] / 2 + rng.uniform(-2, 2), lane)
    course = moving(start, SPEED)
    # The target alone sways: else a constant velocity would predict it too well.
    own = hatchback.on(swaying(course, _swing(2.0, 90, rng), _swing(0.7, 130, rng)))
    ahead = LaneVehicle(saloon((62, 84, 132)), lane)
    # Faster ahead and slower behind than `SPEED`: nobody drives through anybody in one lane.
    leader = ahead.on(moving(ahead.box(start.x + rng.uniform(105, 125), lane), 3.05))
    behind = any_car(lane, rng)
    follower = behind.on(moving(behind.box(rng.uniform(-190, -150), lane), 2.75))
    # The target last: `highway` finds it, and its truth counts what is painted after it as hiding.
    return [*leader, *follower, *own]


def _swing(amplitude: float, period: float, rng: np.random.Generator) -> Wave:
    return wave(amplitude, period, rng.uniform(0, 2 * math.pi))


def _middle_lane(rng: np.random.Generator) -> list[Actor]:
    """Make the lorry that overtakes the target, with a car well ahead and one well behind."""
    lane = FAR_LANES[1]
    truck = LaneVehicle(lorry((176, 120, 40), (204, 200, 190), (122, 40, 52)), lane)
    speed = SPEED + OVERTAKING * rng.uniform(0.95, 1.05)
    meeting = START_PX + SPEED * HIDDEN_AT + rng.uniform(-6, 6)
    # Backwards from where the lorry's box has to be in that frame.
    left = meeting - LOAD_MIDDLE * truck.size[0] - speed * HIDDEN_AT
    actors = list(truck.on(moving(truck.box(left, lane), speed)))
    for model, place in (
        (LaneVehicle(saloon((216, 214, 208)), lane), left + truck.size[0] + rng.uniform(390, 480)),
        (LaneVehicle(car((150, 40, 38)), lane), left - rng.uniform(175, 265)),
    ):
        actors += model.on(moving(model.box(place, lane), speed))
    return actors
