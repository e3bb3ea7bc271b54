"""Scenes in which the target passes behind things that stand: bars, bridges, signs, trees."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.bridges import bridge as make_bridge
from vehicle_pf_tracker.scenes.drive import Drive, DriveParameters
from vehicle_pf_tracker.scenes.obstacles import pillar, post, sign, tree
from vehicle_pf_tracker.scenes.randomness import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene


@dataclass(frozen=True, slots=True)
class HidingParameters(DriveParameters):
    """What can be chosen where one thing hides the target."""

    hidden: float = parameter(
        15.0, "longer occlusions leave more to prediction",
        minimum=1.0, maximum=40.0, unit="frames",
    )  # fmt: skip


def hiding_width(drive: Drive, frames: float) -> float:
    """Width (px) of what hides the target wholly for about `frames` frames."""
    return drive.target.size[0] + frames * drive.parameters.speed


def bridge_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Lead a bridge over the road that hides the target for `frames` frames."""
    width = hiding_width(drive, frames)
    left = drive.x(drive.along(share)) - width / 2
    return list(make_bridge(left, width, drive.height, stream(drive.seed, "bridge")))


def sign_at(drive: Drive, share: float, frames: float, name: str = "sign") -> list[Actor]:
    """Put up a road sign that hides the target for `frames` frames."""
    middle, width = drive.x(drive.along(share)), hiding_width(drive, frames)
    height = drive.target.size[1]
    board = width, drive.row - height - 12, drive.row + 0.4 * height + 8
    foot = drive.opposite.rows.stop + 22
    return sign(middle, board, foot, stream(drive.seed, name))


def pillar_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Put up a pillar that hides the target for `frames` frames."""
    middle, width = drive.x(drive.along(share)), hiding_width(drive, frames)
    return pillar(middle, width, drive.height, stream(drive.seed, "pillar"))


def posts_at(drive: Drive, shares: tuple[float, ...], width: float = 9.0) -> list[Actor]:
    """Put up lamp posts, which hide a part of the target for a moment."""
    foot = drive.opposite.rows.stop + 14
    return [
        actor for share in shares for actor in post(drive.x(drive.along(share)), width, -5, foot)
    ]


def trees_at(drive: Drive, shares: tuple[float, ...], density: float = 0.36) -> list[Actor]:
    """Plant trees whose thin crowns hide a part of the target."""
    rng = stream(drive.seed, "trees")
    length, height = drive.target.size
    actors: list[Actor] = []
    for share in shares:
        top = drive.row - rng.uniform(0.9, 1.2) * height
        crown = rng.uniform(1.3, 1.8) * length, top, top + rng.uniform(75, 95)
        foot = drive.opposite.rows.stop + rng.uniform(8, 30)
        actors += tree(drive.x(drive.along(share)), crown, foot, density, rng)
    return actors


def bars(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: four pillars of rising width; the last two hide the target wholly."""
    drive = Drive(parameters, seed)
    rng = stream(seed, "pillars")
    widths = 12.0, 0.7 * drive.target.size[0], hiding_width(drive, 4), hiding_width(drive, 10)
    places = 0.15, 0.22, 0.335, 0.65
    front = [
        actor
        for share, width in zip(places, widths, strict=True)
        for actor in pillar(drive.x(drive.along(share)), width, drive.height, rng)
    ]
    return drive.scene("bars", front)


def bridge(parameters: HidingParameters, seed: int) -> Scene:
    """Make the scene: a bridge across the road."""
    drive = Drive(parameters, seed)
    return drive.scene("bridge", bridge_at(drive, 0.5, parameters.hidden))


def signs(parameters: HidingParameters, seed: int) -> Scene:
    """Make the scene: lamp posts, and a large sign that hides the target."""
    drive = Drive(parameters, seed)
    front = [*posts_at(drive, (0.2, 0.82)), *sign_at(drive, 0.47, parameters.hidden)]
    return drive.scene("signs", front)


def trees(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: trees along the road, each of which hides a part of the target."""
    drive = Drive(parameters, seed)
    return drive.scene("trees", trees_at(drive, (0.25, 0.43, 0.6, 0.78)))
