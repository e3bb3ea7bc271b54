# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The laboratory's scenes by name: those with one target, and those with many vehicles."""

from __future__ import annotations

from functools import partial

from laboratory.scenes.depth import ScaleParameters, scale
from laboratory.scenes.drives import AccelerationParameters, acceleration, cross, dense
from laboratory.scenes.flow import TrafficSceneParameters
from laboratory.scenes.light import IlluminationParameters, ShadowParameters, illumination, shadows
from laboratory.scenes.road import RoadSceneParameters, road
from laboratory.scenes.traffic_close import CloseParameters, close_scene
from laboratory.scenes.traffic_perspective import PerspectiveParameters, perspective_scene
from laboratory.scenes.traffic_scene import TrafficScene, traffic
from laboratory.scenes.turns import turn, turn_occluded
from vehicle_pf_tracker.scenes import catalogue
from vehicle_pf_tracker.scenes.catalogue import SceneKind
from vehicle_pf_tracker.scenes.drive import DriveParameters

LABORATORY_SCENES = catalogue.SCENES | {
    "turn": SceneKind(DriveParameters, turn, "the target turns into a side road"),
    "turn_occluded": SceneKind(DriveParameters, turn_occluded, "it turns behind a house"),
    "cross": SceneKind(DriveParameters, cross, "a coach crosses the road in front of the target"),
    "dense": SceneKind(DriveParameters, dense, "full lanes; vehicles hide parts of the target"),
    "shadows": SceneKind(ShadowParameters, shadows, "strong shadows of trees across the road"),
    "illumination": SceneKind(IlluminationParameters, illumination, "a cloud passes"),
    "acceleration": SceneKind(AccelerationParameters, acceleration, "faster, and slower again"),
    "scale": SceneKind(ScaleParameters, scale, "the target drives into depth and changes its size"),
    "road": SceneKind(RoadSceneParameters, road, "a road in perspective, at a speed in km/h"),
}
"""All scenes with one target, by name."""


def _traffic(summary: str, **settings: object) -> SceneKind[TrafficScene]:
    return SceneKind(TrafficSceneParameters, traffic, summary, settings)


def _perspective(summary: str, **settings: object) -> SceneKind[TrafficScene]:
    return SceneKind(PerspectiveParameters, perspective_scene, summary, settings)


# Each scene has a difficulty of its own. Numbers of vehicles, gaps and frames are choices by which
# it comes about several times.
TRAFFIC_SCENES: dict[str, SceneKind[TrafficScene]] = {
    "traffic-pair": _traffic(
        "a car overtakes behind a lorry, which hides it",
        vehicles=2, directions=1, lanes=2, lorries=0.5, frames=240,
    ),
    "traffic-lanes": _traffic(
        "twenty vehicles; the fast ones change lanes",
        vehicles=20, changing=True, gap=14.0, lorries=0.2, frames=350,
    ),
    "traffic-queue": _traffic(
        "all wait at a red light, and go on", vehicles=24, lorries=0.0, flow="queue", frames=540
    ),
    "traffic-waves": _traffic("stop and go", vehicles=30, flow="waves", gap=12.0, frames=600),
    "traffic-lorries": _traffic(
        "lorries hide several cars at once",
        vehicles=24, lanes=2, lorries=0.25, gap=12.0, frames=500,
    ),
    "traffic-bridge": _traffic(
        "a bridge hides every vehicle once", vehicles=16, bridges=1, bridge_width=90.0
    ),
    "traffic-forty": _traffic(
        "forty vehicles, about 180 total occlusions",
        vehicles=40, bridges=5, bridge_width=58.0, lorries=0.05, frames=650,
    ),
    "traffic-eighty": _traffic(
        "eighty vehicles in eight lanes",
        vehicles=80, lanes=4, gap=9.0, changing=True, flow="waves", frames=600,
    ),
    "traffic-gantry": _perspective(
        "lorries among cars hide those behind them",
        vehicles=20, view="gantry", mixed=True, lanes=2, lorries=0.25, lorry_speed=0.8,
        gap=12.0, changing=True, frames=360,
    ),
    "traffic-overtaking": _perspective(
        "lorries overtake cars and hide them for 1 to 3 s",
        vehicles=16, view="mast", directions=1, lanes=2, lorries=0.25, lorry_speed=1.3,
        speed=50.0, gap=14.0, frames=360,
    ),
    "traffic-jam": _perspective(
        "a queue at a red light, in which each hides parts of the next",
        vehicles=24, view="gantry", mixed=True, lanes=3, directions=1, lorries=0.15,
        lorry_speed=0.9, flow="queue", gap=9.0, frames=420,
    ),
    "traffic-close": SceneKind(
        CloseParameters,
        close_scene,
        "a close road before a shaking camera; each vehicle is in view for about a second",
        {"vehicles": 24, "speed": 50.0, "gap": 22.0, "frames": 420, "frame_rate": 25.0},
    ),
}  # fmt: skip
"""The scenes with many vehicles, by name."""

make_scene = partial(catalogue.scene_of, LABORATORY_SCENES)
make_traffic_scene = partial(catalogue.scene_of, TRAFFIC_SCENES)
