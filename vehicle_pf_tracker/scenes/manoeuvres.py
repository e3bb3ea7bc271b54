"""Scenes about how the target drives: steadily, faster and slower, round a corner, into depth."""

from __future__ import annotations

import math
from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.courses import Pace
from vehicle_pf_tracker.scenes.drive import RADIUS, Drive, DriveParameters
from vehicle_pf_tracker.scenes.obstacles import house
from vehicle_pf_tracker.scenes.randomness import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import ELEVATION
from vehicle_pf_tracker.scenes.standing_obstacles import bridge_at


@dataclass(frozen=True, slots=True)
class BrakingParameters(DriveParameters):
    """What can be chosen about a change of speed out of sight."""

    change: float = parameter(
        0.6, "speed after the occlusion over that before; above 1 accelerates",
        minimum=0.4, maximum=1.8,
    )  # fmt: skip
    hidden: float = parameter(
        16.0, "longer occlusions leave more to prediction",
        minimum=4.0, maximum=40.0, unit="frames",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class AccelerationParameters(DriveParameters):
    """What can be chosen about a change of speed in sight."""

    change: float = parameter(
        2.2, "highest speed over the speed at the start and at the end", minimum=1.0, maximum=3.0
    )


def clear(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: nothing in the way, at a constant speed."""
    return Drive(parameters, seed).scene("clear")


def acceleration(parameters: AccelerationParameters, seed: int) -> Scene:
    """Make the scene: the target speeds up, holds the speed, and brakes."""
    low, high = parameters.speed, parameters.speed * parameters.change
    knots = (0.0, low), (14.0, low), (34.0, high), (48.0, high), (64.0, low)
    return Drive(parameters, seed, Pace(knots)).scene("acceleration")


def braking(parameters: BrakingParameters, seed: int) -> Scene:
    """Make the scene: the target changes its speed under a bridge."""
    before, after = parameters.speed, parameters.speed * parameters.change
    plain = Drive(parameters, seed)
    frame = plain.frame_at(plain.along(0.5))
    half = 0.35 * parameters.hidden
    drive = Drive(
        parameters, seed, Pace(((0, before), (frame - half, before), (frame + half, after)))
    )
    mean = (before + after) / 2 / before
    return drive.scene("braking", bridge_at(drive, 0.5, parameters.hidden * mean))


def turn(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target turns into a side road, away from the viewer."""
    return turning(parameters, seed).scene("turn", behind=())


def turn_occluded(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target turns into a side road behind a house."""
    drive = turning(parameters, seed)
    return drive.scene("turn_occluded", house_at_corner(drive), behind=())


def turning(parameters: DriveParameters, seed: int) -> Drive:
    """Make a drive that turns into a side road a little before the middle of the image."""
    corner = Drive(parameters, seed).along(0.42 + stream(seed, "corner").uniform(-0.02, 0.02))
    return Drive(parameters, seed, corner=corner)


def house_at_corner(drive: Drive) -> list[Actor]:
    """Build a house on the near side that hides the turn of `drive`, which has a corner."""
    assert drive.corner is not None
    length, height = drive.target.size
    near, far = drive.corner - 0.7 * length, drive.corner + RADIUS + 0.6 * length
    left = min(drive.x(near), drive.x(far))
    top = drive.row - RADIUS * math.sin(ELEVATION) - 1.2 * height
    box = Box(left, top, far - near, drive.road.rows.stop + 50 - top)
    return house(box, (196, 178, 150), stream(drive.seed, "house"))
