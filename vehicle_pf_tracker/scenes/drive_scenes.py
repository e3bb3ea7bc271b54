# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes in which a target drives along a road: what stands, or drives, in its way."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.courses import Pace
from vehicle_pf_tracker.scenes.drive import TARGET_LANE, Drive, DriveParameters
from vehicle_pf_tracker.scenes.obstacles import bridge as make_bridge
from vehicle_pf_tracker.scenes.obstacles import pillar, tree
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.vehicles import coach

COACH_LENGTH = 12.0
"""Length of a coach, m: three times that of the cars it hides."""


@dataclass(frozen=True, slots=True)
class HidingParameters(DriveParameters):
    """Parameters of scenes in which one obstacle hides the target."""

    hidden: float = parameter(
        15.0, "longer occlusions leave more to prediction",
        bounds=(1.0, 40.0), unit="frames",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class BrakingParameters(DriveParameters):
    """Parameters of a change of speed during an occlusion."""

    change: float = parameter(
        0.6, "speed after the occlusion over that before; above 1 accelerates",
        bounds=(0.4, 1.8),
    )  # fmt: skip
    hidden: float = parameter(
        16.0, "longer occlusions leave more to prediction",
        bounds=(4.0, 40.0), unit="frames",
    )  # fmt: skip


def hiding_width(drive: Drive, frames: float) -> float:
    """Width (px) of what hides the target wholly for about `frames` frames."""
    # As long as the target to hold all of it, and what it drives while it is wholly behind.
    return drive.target.size[0] + frames * drive.parameters.speed


def bridge_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Lead a bridge over the road that hides the target for `frames` frames."""
    width = hiding_width(drive, frames)
    left = drive.x(drive.along(share)) - width / 2
    return list(make_bridge(left, width, drive.height, stream(drive.seed, "bridge")))


def trees_at(drive: Drive, shares: tuple[float, ...], density: float = 0.36) -> list[Actor]:
    """Plant trees whose thin crowns hide a part of the target."""
    rng = stream(drive.seed, "trees")
    length, height = drive.target.size
    actors: list[Actor] = []
    # Shape and size in multiples of the target, by chance: wide enough to cover all of it, with the
    # gaps of a thin crown (`density`) between. The ranges are a choice.
    for share in shares:
        top = drive.row - rng.uniform(0.9, 1.2) * height
        crown = rng.uniform(1.3, 1.8) * length, top, top + rng.uniform(75, 95)
        # On the side of the viewer, below both roads: the crowns stand in front of them.
        foot = drive.opposite.rows.stop + rng.uniform(8, 30)
        actors += tree(drive.x(drive.along(share)), crown, foot, density, rng)
    return actors


def bars(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: four pillars of rising width; the last two hide the target wholly."""
    drive = Drive(parameters, seed)
    rng = stream(seed, "pillars")
    # From a pole that hides a part to a pillar that hides all for ten frames (`hiding_width`).
    widths = 12.0, 0.7 * drive.target.size[0], hiding_width(drive, 4), hiding_width(drive, 10)
    places = 0.15, 0.22, 0.335, 0.65
    front = [
        actor
        for share, width in zip(places, widths, strict=True)
        for actor in pillar(drive.x(drive.along(share)), width, drive.height, rng)
    ]
    return drive.scene(front)


def bridge(parameters: HidingParameters, seed: int) -> Scene:
    """Make the scene: a bridge across the road."""
    drive = Drive(parameters, seed)
    return drive.scene(bridge_at(drive, 0.5, parameters.hidden))


def trees(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: trees along the road, each of which hides a part of the target."""
    drive = Drive(parameters, seed)
    return drive.scene(trees_at(drive, (0.25, 0.43, 0.6, 0.78)))


def coach_at(
    drive: Drive, share: float, frames: float, length: float = COACH_LENGTH
) -> list[Actor]:
    """Let a coach overtake in the nearer lane and hide the target for about `frames` frames.

    `length` is the coach's, in metres.
    """
    # It is hidden while what the coach is longer by passes it: spare = frames * relative speed.
    spare = length * drive.scale - drive.target.size[0]
    speed = drive.parameters.speed + spare / frames
    faces = coach((206, 204, 196), (34, 82, 128), length)
    return drive.meeting(faces, drive.along(share), speed)


def bus(parameters: HidingParameters, seed: int) -> Scene:
    """Make the scene: a coach overtakes and hides the target."""
    drive = Drive(parameters, seed)
    return drive.scene(coach_at(drive, 0.45, parameters.hidden))


def twin(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: a vehicle of the same make and colour overtakes slowly in the far lane."""
    drive = Drive(parameters, seed)
    # 10 % faster than the target: at 5 px/frame it needs 86 frames to get ahead by its own length,
    # 43 px, and so is beside it for most of the video. A choice.
    other = drive.meeting(
        drive.faces, drive.along(0.5), 1.1 * parameters.speed, lane=TARGET_LANE - 1
    )
    return drive.scene(drive.opposite_traffic(), behind=other)


def clear(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: nothing in the way, at a constant speed."""
    return Drive(parameters, seed).scene()


def braking(parameters: BrakingParameters, seed: int) -> Scene:
    """Make the scene: the target changes its speed under a bridge."""
    before = parameters.speed
    after = parameters.speed * parameters.change
    # 1. A drive at a constant speed says in which frame the target is under the bridge's middle.
    plain = Drive(parameters, seed)
    frame = plain.frame_at(plain.along(0.5))
    half = 0.35 * parameters.hidden
    # 2. The speed changes over 70 % of the hidden time, around that frame: hardly a frame shows it.
    drive = Drive(
        parameters, seed, Pace(((0, before), (frame - half, before), (frame + half, after)))
    )
    # 3. `hiding_width` reckons with the speed before; the mean of both keeps the hidden time.
    mean = (before + after) / 2 / before
    return drive.scene(bridge_at(drive, 0.5, parameters.hidden * mean))
