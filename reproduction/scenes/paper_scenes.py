# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes after the papers' videos and cases, beside those of the package and the laboratory.

Sources: Scharcanski et al. 2011, table I (vehicle, occlusion, resolution) and figure 5 (in its
video 3 signs, then a bus hide the vehicle); Abdulla et al., section V (cases 1 to 6); Khong et al.,
section VI (the phases before, partially, fully and after occluded, and their timing). The papers
say what happens; what hides the other videos' vehicles, and all speeds, are ours.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from laboratory import scenes as laboratory_scenes
from laboratory.scenes.drives import cross, dense, near_traffic
from laboratory.scenes.light import tree_shadows
from laboratory.scenes.turns import TURN_RADIUS, TurningDrive
from reproduction.scenes.signs import posts_at, sign_at
from vehicle_pf_tracker.core.truth import TOTAL_BELOW
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.scenes import catalogue
from vehicle_pf_tracker.scenes.catalogue import SceneKind
from vehicle_pf_tracker.scenes.courses import Pace
from vehicle_pf_tracker.scenes.drive import TARGET_LANE, Drive, DriveParameters
from vehicle_pf_tracker.scenes.drive_scenes import (
    bridge_at,
    clear,
    coach_at,
    hiding_width,
    trees_at,
)
from vehicle_pf_tracker.scenes.obstacles import pillar, tree
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION, Face
from vehicle_pf_tracker.scenes.turning_vehicle import TurningVehicle
from vehicle_pf_tracker.scenes.vehicles import coach, van

Build: TypeAlias = Callable[[DriveParameters, int], Scene]
"""Function that makes a scene from the parameters of a drive and a seed."""


@dataclass(frozen=True, slots=True)
class NoParameters:
    """No parameters: only the seed varies."""


@dataclass(frozen=True, slots=True)
class FixedScene:
    """A row of a table.

    Attributes
    ----------
    name : str
        Name in the catalogue.
    occlusion : {"partial and total", "total", "partial", "none"}
        Kind of occlusion. Every total occlusion begins and ends partial; "partial" stands
        for one of its own.
    what : str
        Content of the scene.
    parameters : DriveParameters
        The vehicle, the image and the road.
    build : callable
        Makes a scene from such parameters and a seed.
    """

    name: str
    occlusion: str
    what: str
    parameters: DriveParameters
    build: Build

    @property
    def summary(self) -> str:
        """The row in one line."""
        chosen = self.parameters
        return f"{self.what}: {chosen.vehicle}, {chosen.resolution}, occlusion {self.occlusion}"

    def scene(self, parameters: NoParameters, seed: int) -> Scene:
        """Make the scene; rows of one seed differ in vehicle, traffic and ground."""
        own = int(stream(seed, self.name).integers(2**32))
        return self.build(self.parameters, own)


def past(*obstacles: Callable[[Drive], list[Actor]]) -> Build:
    """Drive past `obstacles`, the farthest first, among other traffic."""

    def build(parameters: DriveParameters, seed: int) -> Scene:
        drive = Drive(parameters, seed)
        front = [actor for obstacle in obstacles for actor in obstacle(drive)]
        return drive.scene(front)

    return build


def chosen(kind: str, speed: float, heading: str, others: Mapping[str, str]) -> DriveParameters:
    """Choose the vehicle, its speed (px/frame), where it heads, and `others` by name."""
    values = {"vehicle": kind, "speed": speed, "heading": heading, **others}
    return from_mapping(DriveParameters, values)


def pillar_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Put up a pillar that hides the target for `frames` frames."""
    middle = drive.x(drive.along(share))
    width = hiding_width(drive, frames)
    return pillar(middle, width, drive.height, stream(drive.seed, "pillar"))


def van_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Let the target overtake a van in the nearer lane, half hidden by it for about `frames`."""
    faces = van((196, 196, 190))
    length = TurningVehicle(faces, drive.scale).size[0]
    speed = drive.parameters.speed - (length + drive.target.size[0]) / frames
    return drive.meeting(faces, drive.along(share), speed)


def _turn_past_trees(parameters: DriveParameters, seed: int) -> Scene:
    drive = TurningDrive(parameters, seed)
    return drive.scene(trees_at(drive, (0.2, 0.36)), behind=())


_LARGE = {"resolution": "768x576"}
_TOWN = {"surroundings": "town"}
_ROUGH = {"disturbance": "rough"}

_BOTH, _TOTAL, _PARTIAL = "partial and total", "total", "partial"

_VIDEO_TABLE = (
    FixedScene("video01", _BOTH, "a tree, a bridge", chosen("suv", 4.5, "right", {}),
               past(lambda d: trees_at(d, (0.23,)), lambda d: bridge_at(d, 0.55, 14))),
    FixedScene("video02", _BOTH, "a lamp post, a coach", chosen("car", 4.5, "left", _ROUGH),
               past(lambda d: coach_at(d, 0.5, 16), lambda d: posts_at(d, (0.18,), 14))),
    FixedScene("video03", _BOTH, "a lamp post, a sign, a coach", chosen("suv", 4.0, "right", {}),
               past(lambda d: coach_at(d, 0.68, 10), lambda d: posts_at(d, (0.15,), 12),
                    lambda d: sign_at(d, 0.34, 8))),
    FixedScene("video04", _TOTAL, "a bridge", chosen("car", 6.0, "left", {}),
               past(lambda d: bridge_at(d, 0.45, 18))),
    FixedScene("video05", _TOTAL, "a bridge", chosen("truck", 4.0, "right", _ROUGH),
               past(lambda d: bridge_at(d, 0.45, 14))),
    FixedScene("video06", _TOTAL, "a sign", chosen("truck", 4.5, "left", {}),
               past(lambda d: sign_at(d, 0.45, 8))),
    FixedScene("video07", _TOTAL, "a pillar", chosen("truck", 5.0, "right", _TOWN),
               past(lambda d: pillar_at(d, 0.45, 6))),
    FixedScene("video08", _TOTAL, "a coach", chosen("car", 5.0, "right", _TOWN),
               past(lambda d: coach_at(d, 0.45, 14))),
    FixedScene("video09", _TOTAL, "a coach that crosses", chosen("car", 5.0, "left", {}), cross),
    FixedScene("video10", _TOTAL, "a sign", chosen("car", 7.0, "left", _ROUGH),
               past(lambda d: sign_at(d, 0.45, 10))),
    FixedScene("video11", _TOTAL, "a bridge", chosen("truck", 5.5, "left", {}),
               past(lambda d: bridge_at(d, 0.42, 16))),
    FixedScene("video12", _PARTIAL, "trees", chosen("car", 5.0, "right", {**_LARGE, **_TOWN}),
               past(lambda d: trees_at(d, (0.25, 0.5, 0.74)))),
    FixedScene("video13", _PARTIAL, "dense traffic", chosen("car", 5.5, "left", _LARGE), dense),
    FixedScene("video14", _PARTIAL, "lamp posts",
               chosen("car", 6.0, "left", {**_LARGE, **_TOWN, **_ROUGH}),
               past(lambda d: posts_at(d, (0.22, 0.42, 0.62, 0.82), 15))),
    FixedScene("video15", _PARTIAL, "a van that it overtakes",
               chosen("car", 6.5, "right", _LARGE),
               past(lambda d: van_at(d, 0.5, 40))),
    FixedScene("video16", _PARTIAL, "trees before a turn",
               chosen("car", 5.0, "right", {**_TOWN, **_LARGE}),
               _turn_past_trees),
    FixedScene("video17", _PARTIAL, "a van and a lamp post",
               chosen("car", 5.0, "left", {**_LARGE, **_ROUGH}),
               past(lambda d: van_at(d, 0.4, 30), lambda d: posts_at(d, (0.72,), 15))),
    FixedScene("video18", _PARTIAL, "faster traffic", chosen("car", 5.0, "right", _LARGE),
               past(near_traffic)),
    FixedScene("video19", "none", "nothing", chosen("car", 5.0, "left", {}), clear),
    FixedScene("video20", "none", "nothing",
               chosen("car", 6.0, "right", {**_TOWN, **_ROUGH}), clear),
)  # fmt: skip

VIDEO_SCENES: dict[str, FixedScene] = {video.name: video for video in _VIDEO_TABLE}
"""Scenes after the first paper's twenty videos, by name."""


SHADE_DEPTH = 0.55
"""Share of the light that trees take away."""
# Frames of the first three phases of `phases`; the fourth is what remains of the way.
BEFORE = 40
PARTIAL = 30
FULL = 20


def _turn_behind_trees(parameters: DriveParameters, seed: int) -> Scene:
    """Turn behind the thick crowns of two trees on the near side."""
    drive = TurningDrive(parameters, seed)
    rng = stream(seed, "trees")
    top = drive.row - TURN_RADIUS * math.sin(VIEW_ELEVATION) - 1.1 * drive.target.size[1]
    foot = drive.road.rows.stop + 40
    front = [
        actor
        for share in (0.1, 0.9)
        for actor in tree(
            drive.x(drive.corner + share * TURN_RADIUS), (105, top, drive.row + 45), foot, 0.8, rng
        )
    ]
    return drive.scene(front, behind=())


def _past_parked_vehicles(drive: Drive) -> list[Actor]:
    """Park a van that hides a part of the target, and a coach behind which it disappears."""
    length = drive.target.size[0]
    speed = drive.parameters.speed
    van_rear = drive.start + length / 2 + BEFORE * speed
    # Total begins and ends with a tenth of the vehicle visible.
    coach_rear = van_rear + PARTIAL * speed - (1 - TOTAL_BELOW) * length
    coach_length = ((1 - 2 * TOTAL_BELOW) * length + FULL * speed) / drive.scale
    parked = (van((206, 206, 200)), van_rear), (
        coach((178, 60, 50), (226, 222, 210), coach_length), coach_rear
    )  # fmt: skip
    return [actor for faces, rear in parked for actor in _parked(drive, faces, rear)]


def _parked(drive: Drive, faces: list[Face], rear: float) -> tuple[Actor, Actor]:
    """Park a vehicle in the nearer lane, its rear at a place along the way."""
    model = TurningVehicle(faces, drive.scale)
    return model.on(drive.course(rear + model.size[0] / 2, Pace.steady(0.0), TARGET_LANE + 1))


CLEAR = 10
"""Frames until something covers the vehicle: 1 to 10 in figure 4 of Khong et al."""
OVERLAPPED = 4
"""Frames while all but a remnant is covered: about 16 to 19 there."""
_LORRY_HEIGHT = 1.19
"""Height of what is parked, in vans: a seventh of the vehicle stays visible above it
(`python -m reproduction resampling-frames` says between which shares)."""


def _past_a_parked_lorry(drive: Drive) -> list[Actor]:
    """Park a lorry of one colour that leaves only the edge of the target's roof visible."""
    length = drive.target.size[0]
    speed = drive.parameters.speed
    rear = drive.start + length / 2 + CLEAR * speed
    stretch = (length + OVERLAPPED * speed) / TurningVehicle(van((0, 0, 0)), drive.scale).size[0]
    faces = [
        face.moved(lambda x, y, z: (x * stretch, y, z * _LORRY_HEIGHT))
        for face in van((206, 206, 200))
    ]
    return list(_parked(drive, faces, rear))


_CASE_TABLE = (
    FixedScene("case1", "partial", "trees hide parts of the vehicle",
               chosen("car", 4.0, "right", {}),
               past(lambda d: trees_at(d, (0.27, 0.45, 0.62, 0.8), 0.42))),
    FixedScene("case2", "partial", "it overtakes a van that hides its lower half for long",
               chosen("car", 4.5, "right", {}), past(lambda d: van_at(d, 0.5, 60))),
    FixedScene("case3", "none", "trees cast shadows on the road and the vehicle",
               chosen("car", 4.0, "left", {"surroundings": "town"}),
               past(lambda d: tree_shadows(d, (0.2, 0.32, 0.47, 0.6, 0.74, 0.9), SHADE_DEPTH))),
    FixedScene("case4", "total", "a coach alongside hides it for 70 frames",
               chosen("car", 3.4, "right", {}), past(lambda d: coach_at(d, 0.46, 64, 15.0))),
    FixedScene("case5", "partial and total", "shadows, a post, and two pillars that hide it",
               chosen("car", 4.0, "left", {}),
               past(lambda d: tree_shadows(d, (0.2, 0.42, 0.58, 0.83), SHADE_DEPTH),
                    lambda d: pillar_at(d, 0.34, 6), lambda d: pillar_at(d, 0.7, 6),
                    lambda d: posts_at(d, (0.52,), 12))),
    FixedScene("case6", "total", "it turns behind trees",
               chosen("car", 4.5, "right", {"surroundings": "town"}), _turn_behind_trees),
    FixedScene("phases", "total", "clear, half hidden by a parked van, hidden by a parked coach",
               chosen("car", 4.0, "right", {}), past(_past_parked_vehicles)),
    FixedScene("overlap", "partial", "clear, then all but a remnant hidden by a parked lorry",
               chosen("car", 8.0, "right", {}), past(_past_a_parked_lorry)),
    FixedScene("disturbances", "partial and total", "a shadow, a tree, and a pillar that hides it",
               chosen("car", 4.0, "left", {}),
               past(lambda d: tree_shadows(d, (0.24,), SHADE_DEPTH),
                    lambda d: trees_at(d, (0.5,), 0.42), lambda d: pillar_at(d, 0.78, 6))),
)  # fmt: skip

CASE_SCENES: dict[str, FixedScene] = {case.name: case for case in _CASE_TABLE}
"""Scenes after the second paper's cases and figure 1, and the third paper's phases, by name."""


FIXED_SCENES: dict[str, FixedScene] = VIDEO_SCENES | CASE_SCENES
"""The scenes after the papers, by name."""
PAPER_SCENES: dict[str, SceneKind[Scene]] = laboratory_scenes.LABORATORY_SCENES | {
    name: SceneKind(NoParameters, row.scene, row.summary) for name, row in FIXED_SCENES.items()
}


def make_scene(
    name: str, *, seed: int = 0, settings: Mapping[str, object] | Sequence[str] = ()
) -> Scene:
    """Make the scene `name`, as `vehicle_pf_tracker.scenes.catalogue.make_scene` does."""
    return catalogue.scene_of(PAPER_SCENES, name, seed=seed, settings=settings)
