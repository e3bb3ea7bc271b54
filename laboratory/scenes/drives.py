# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drives past crossing or dense traffic, and at a changing speed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from laboratory.scenes.turns import side_road
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.compositing import Image
from vehicle_pf_tracker.scenes.courses import Pace, Pose, straight
from vehicle_pf_tracker.scenes.drive import TARGET_LANE, TARGET_PAINTS, Drive, DriveParameters
from vehicle_pf_tracker.scenes.lane_traffic import convoy
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION
from vehicle_pf_tracker.scenes.turning_vehicle import TurningVehicle
from vehicle_pf_tracker.scenes.vehicles import car, coach, saloon, suv, van

CLEAR_FRAMES = 10
"""Frames at the start in which nothing may hide the target: trackers learn it there."""
CROSSING = math.radians(28)
"""Angle between the road and the one that crosses it."""


@dataclass(frozen=True, slots=True)
class AccelerationParameters(DriveParameters):
    """Parameters of a change of speed while visible."""

    change: float = parameter(
        2.2, "highest speed over the speed at the start and at the end", bounds=(1.0, 3.0)
    )


def acceleration(parameters: AccelerationParameters, seed: int) -> Scene:
    """Make the scene: the target speeds up, holds the speed, and brakes."""
    # 14 frames at the first speed to learn the target, then up and down within 1.3 and 1.1 s each.
    low = parameters.speed
    high = parameters.speed * parameters.change
    knots = (0.0, low), (14.0, low), (34.0, high), (48.0, high), (64.0, low)
    return Drive(parameters, seed, Pace(knots)).scene()


def near_traffic(drive: Drive) -> list[Actor]:
    """Fill the nearer lane with faster vehicles, each of which hides a part of the target."""
    rng = stream(drive.seed, "near lane")
    speed = drive.parameters.speed * rng.uniform(1.5, 1.7)
    lane = drive.road.lane(TARGET_LANE + 1)
    # Vans: from the nearer lane a car is too low to cover much of the target.
    others = convoy(lane, speed, drive.stage, rng, (40, 130), (van,))
    return _clear_at_first(drive, others)


def _clear_at_first(drive: Drive, others: list[Actor]) -> list[Actor]:
    """Leave out the vehicles that would hide the target before it has been seen for a while."""
    # Without the driver's swaying, which moves it by 1.5 px at most.
    own = drive.target.on(drive.course(drive.start, drive.pace))[1]
    return [
        actor
        # In pairs: shadow and body, as `convoy` makes them.
        for pair in zip(others[::2], others[1::2], strict=True)
        if not any(pair[1].path(frame).iou(own.path(frame)) > 0 for frame in range(CLEAR_FRAMES))
        for actor in pair
    ]


def dense(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: full lanes, of which the nearer one hides parts of the target."""
    drive = Drive(parameters, seed)
    rng = stream(seed, "dense")
    slow = parameters.speed * rng.uniform(0.7, 0.8)
    fast = parameters.speed * rng.uniform(1.3, 1.5)
    gaps = (14, 60)
    far = convoy(drive.road.lane(TARGET_LANE - 1), slow, drive.stage, rng, gaps)
    near = convoy(drive.road.lane(TARGET_LANE + 1), fast, drive.stage, rng, gaps, (van, suv))
    ahead = _own_lane(drive, rng)
    return drive.scene(
        [*_clear_at_first(drive, near), *drive.opposite_traffic()], behind=[*far, *ahead]
    )


def _own_lane(drive: Drive, rng: np.random.Generator) -> list[Actor]:
    """Make the vehicles before and behind the target in its own lane, as fast as it is."""
    actors: list[Actor] = []
    # Farther apart than a saloon is long, 53 px: nobody touches anybody, as all are as fast.
    for distance in (-200.0, -100.0, 100.0, 200.0):
        faces = (car, saloon)[rng.integers(2)](TARGET_PAINTS[rng.integers(len(TARGET_PAINTS))])
        place = drive.start + distance + rng.uniform(-15, 15)
        actors += TurningVehicle(faces, drive.scale).on(drive.course(place, drive.pace))
    return actors


def cross(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target slows down for a coach that crosses the road before it."""
    base = Drive(parameters, seed)
    speed = parameters.speed
    slow = 0.5 * parameters.speed
    # Braking over 12 frames to half the speed, kept for 14 more: in frame 22 of these the coach
    # is right in front of it.
    brake = base.frame_at(base.along(0.33))
    pace = Pace(
        ((0.0, speed), (brake, speed), (brake + 12, slow), (brake + 26, slow), (brake + 38, speed))
    )
    drive = Drive(parameters, seed, pace)
    scene = drive.scene(_crossing_coach(drive, brake + 22), behind=())
    return replace(scene, backdrop=lambda: _crossroads(drive, brake + 22))


def _crossing_coach(drive: Drive, frame: float) -> list[Actor]:
    """Make the coach whose middle is right in front of the target in `frame`."""
    x, y = _crossing(drive, frame)
    heading = CROSSING - math.pi if drive.rightward else -CROSSING
    pace = Pace(((frame, 0.9 * drive.parameters.speed),))
    model = TurningVehicle(coach((190, 60, 48), (230, 226, 216)), drive.scale)
    return list(model.on(straight(Pose(x, y, heading, drive.scale), pace)))


def _crossing(drive: Drive, frame: float) -> tuple[float, float]:
    """Place of the coach's middle in `frame`: a little nearer to the viewer than the target's."""
    target = drive.course(drive.start, drive.pace)(frame)
    # 18 px nearer to the viewer, so that the coach is painted over the target and hides it.
    return target.x, target.y + 18


def _crossroads(drive: Drive, frame: float) -> Image:
    picture = drive.backdrop()
    x, y = _crossing(drive, frame)
    slope = math.tan(CROSSING) * math.sin(VIEW_ELEVATION) * (-1 if drive.rightward else 1)
    top = -1.0
    bottom = drive.height + 1.0
    # The line through the coach's position, from above the stage to below it.
    ends = (x + (top - y) / slope, top), (x + (bottom - y) / slope, bottom)
    side_road(
        picture, *ends, 7.5 * drive.scale / math.sin(CROSSING), stream(drive.seed, "crossing")
    )
    return picture
