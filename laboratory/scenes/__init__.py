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

"""Scenes for experiments, beside those of the package.

    python -m laboratory.scenes SCENE OUT

writes one, as `vehicle-pf-tracker synth` writes those of the package.
"""

from __future__ import annotations

from functools import partial

from laboratory.scenes.depth import ScaleParameters, scale
from laboratory.scenes.drives import (
    AccelerationParameters,
    IlluminationParameters,
    ShadowParameters,
    acceleration,
    cross,
    dense,
    illumination,
    shadows,
)
from laboratory.scenes.road import RoadSceneParameters, road
from laboratory.scenes.traffic_close import CloseParameters, close_scene
from laboratory.scenes.traffic_perspective import PerspectiveParameters, perspective_scene
from vehicle_pf_tracker.scenes import catalogue
from vehicle_pf_tracker.scenes.catalogue import SceneKind
from vehicle_pf_tracker.scenes.drive import DriveParameters

SCENES = catalogue.SCENES | {
    "cross": SceneKind(DriveParameters, cross, "a coach crosses the road in front of the target"),
    "dense": SceneKind(DriveParameters, dense, "full lanes; vehicles hide parts of the target"),
    "shadows": SceneKind(ShadowParameters, shadows, "strong shadows of trees across the road"),
    "illumination": SceneKind(IlluminationParameters, illumination, "a cloud passes"),
    "acceleration": SceneKind(AccelerationParameters, acceleration, "faster, and slower again"),
    "scale": SceneKind(ScaleParameters, scale, "the target drives into depth and changes its size"),
    "road": SceneKind(RoadSceneParameters, road, "a road in perspective, at a speed in km/h"),
}
"""All scenes with one target, by name."""

TRAFFIC_SCENES = catalogue.TRAFFIC_SCENES | {
    "traffic-gantry": SceneKind(
        PerspectiveParameters,
        perspective_scene,
        "lorries among cars hide those behind them",
        {
            "vehicles": 20,
            "view": "gantry",
            "mixed": True,
            "lanes": 2,
            "lorries": 0.25,
            "lorry_speed": 0.8,
            "gap": 12.0,
            "changing": True,
            "frames": 360,
        },
    ),
    "traffic-overtaking": SceneKind(
        PerspectiveParameters,
        perspective_scene,
        "lorries overtake cars and hide them for 1 to 3 s",
        {
            "vehicles": 16,
            "view": "mast",
            "directions": 1,
            "lanes": 2,
            "lorries": 0.25,
            "lorry_speed": 1.3,
            "speed": 50.0,
            "gap": 14.0,
            "frames": 360,
        },
    ),
    "traffic-jam": SceneKind(
        PerspectiveParameters,
        perspective_scene,
        "a queue at a red light, in which each hides parts of the next",
        {
            "vehicles": 24,
            "view": "gantry",
            "mixed": True,
            "lanes": 3,
            "directions": 1,
            "lorries": 0.15,
            "lorry_speed": 0.9,
            "flow": "queue",
            "gap": 9.0,
            "frames": 420,
        },
    ),
    "traffic-close": SceneKind(
        CloseParameters,
        close_scene,
        "a close road before a shaking camera; each vehicle is in view for about a second",
        {"vehicles": 24, "speed": 50.0, "gap": 22.0, "frames": 420, "frame_rate": 25.0},
    ),
}
"""All scenes with many vehicles, by name."""

make_scene = partial(catalogue.make_scene, scenes=SCENES)
make_traffic_scene = partial(catalogue.make_traffic_scene, scenes=TRAFFIC_SCENES)
