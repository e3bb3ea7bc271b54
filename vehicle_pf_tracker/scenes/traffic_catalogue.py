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

"""The scenes with many vehicles by name, and how to make one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.table import (
    from_mapping,
    parse_assignments,
    specs,
)
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.compositing import Image, check_seed, stream
from vehicle_pf_tracker.scenes.flow import draw_lorries, drive
from vehicle_pf_tracker.scenes.obstacles import bridge
from vehicle_pf_tracker.scenes.roads import PAINTS, Carriageway, Lane, Vehicle, any_car, countryside
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.traffic_perspective import perspective_scene
from vehicle_pf_tracker.scenes.traffic_scene import TrafficScene, TrafficSceneParameters
from vehicle_pf_tracker.scenes.vehicles import lorry

WIDTH, HEIGHT = 640, 360
SCALE = 7.0
"""px per metre: a car is about 30 px long, a lorry 80."""
_TOP = 66
"""First row of asphalt, px."""
_MEDIAN = 34
"""Rows between the two carriageways, px."""


@dataclass(frozen=True, slots=True)
class TrafficSceneKind:
    """An entry of the catalogue.

    Attributes
    ----------
    settings : mapping of str to object
        Parameters that differ from the defaults.
    summary : str
        Content of the scene, in one line.
    """

    settings: Mapping[str, object]
    summary: str


TRAFFIC_SCENES: dict[str, TrafficSceneKind] = {
    "traffic-pair": TrafficSceneKind(
        {"vehicles": 2, "directions": 1, "lanes": 2, "lorries": 0.5, "frames": 240},
        "a car overtakes behind a lorry, which hides it",
    ),
    "traffic-lanes": TrafficSceneKind(
        {"vehicles": 20, "changing": True, "gap": 14.0, "lorries": 0.2, "frames": 350},
        "twenty vehicles; the fast ones change lanes",
    ),
    "traffic-queue": TrafficSceneKind(
        {"vehicles": 24, "lorries": 0.0, "flow": "queue", "frames": 540},
        "all wait at a red light, and go on",
    ),
    "traffic-waves": TrafficSceneKind(
        {"vehicles": 30, "flow": "waves", "gap": 12.0, "frames": 600}, "stop and go"
    ),
    "traffic-lorries": TrafficSceneKind(
        {"vehicles": 24, "lanes": 2, "lorries": 0.25, "gap": 12.0, "frames": 500},
        "lorries hide several cars at once",
    ),
    "traffic-gantry": TrafficSceneKind(
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
        "in perspective; lorries among cars hide those behind them",
    ),
    "traffic-overtaking": TrafficSceneKind(
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
        "in perspective; lorries overtake cars and hide them for 1 to 3 s",
    ),
    "traffic-jam": TrafficSceneKind(
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
        "in perspective; a queue at a red light, in which each hides parts of the next",
    ),
    "traffic-bridge": TrafficSceneKind(
        {"vehicles": 16, "bridges": 1, "bridge_width": 90.0}, "a bridge hides every vehicle once"
    ),
    "traffic-forty": TrafficSceneKind(
        {"vehicles": 40, "bridges": 5, "bridge_width": 58.0, "lorries": 0.05, "frames": 650},
        "forty vehicles, about 180 total occlusions",
    ),
    "traffic-eighty": TrafficSceneKind(
        {"vehicles": 80, "lanes": 4, "gap": 9.0, "changing": True, "flow": "waves", "frames": 600},
        "eighty vehicles in eight lanes",
    ),
}
"""The scenes with many vehicles, by name."""


def make_traffic_scene(
    name: str, *, seed: int = 0, settings: Mapping[str, object] | Sequence[str] = ()
) -> TrafficScene:
    """Make the scene `name`.

    Parameters
    ----------
    name : str
        A key of `TRAFFIC_SCENES`.
    seed : int
        Integer >= 0: changes all that is random in the scene.
    settings : mapping or sequence of str
        Parameters of the scene by name, or ``key=value`` words.

    Raises
    ------
    InputError
        If the scene or a setting is unknown, or a value does not fit.
    """
    if name not in TRAFFIC_SCENES:
        raise InputError(
            f"there is no scene {name!r}{suggestion(name, TRAFFIC_SCENES)}; choose one of "
            f"{', '.join(TRAFFIC_SCENES)}"
        )
    known = specs(TrafficSceneParameters)
    if not isinstance(settings, Mapping):
        names = [word.partition("=")[0] for word in settings]
        _check_names(name, names)
        settings = parse_assignments(known, settings)
    _check_names(name, settings)
    values = {**TRAFFIC_SCENES[name].settings, **settings}
    return _build(name, from_mapping(TrafficSceneParameters, values), check_seed(seed))


def _check_names(scene: str, names: Mapping[str, object] | Sequence[str]) -> None:
    known = [field.name for field in fields(TrafficSceneParameters)]
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError(
            f"the scene {scene} has no setting {', '.join(map(repr, unknown))}"
            f"{suggestion(unknown[0], known)}; "
            f"it has {', '.join(known)}"
        )


def _build(name: str, parameters: TrafficSceneParameters, seed: int) -> TrafficScene:
    if parameters.view != "side":
        return perspective_scene(name, parameters, seed)
    far = Carriageway(_TOP, parameters.lanes, SCALE, rightward=True)
    near = Carriageway(far.rows.stop + _MEDIAN, parameters.lanes, SCALE, rightward=False)
    count = parameters.vehicles if parameters.directions == 1 else (parameters.vehicles + 1) // 2
    vehicles = [
        *_direction(far, count, parameters, stream(seed, "far traffic")),
        *_direction(near, parameters.vehicles - count, parameters, stream(seed, "near traffic")),
    ]
    return TrafficScene(
        name=name,
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=parameters.frames,
        backdrop=partial(_backdrop, (far, near), seed),
        vehicles=tuple(vehicles),
        obstacles=tuple(_bridges(parameters, seed)),
        camera=Camera(parameters.noise, seed),
    )


def _backdrop(roads: tuple[Carriageway, ...], seed: int) -> Image:
    return countryside((HEIGHT, WIDTH), roads, stream(seed, "backdrop"))


def _bridges(parameters: TrafficSceneParameters, seed: int) -> list[Actor]:
    rng = stream(seed, "bridges")
    pitch = WIDTH / (parameters.bridges + 1)
    return [
        actor
        for number in range(1, parameters.bridges + 1)
        for actor in bridge(
            number * pitch - parameters.bridge_width / 2 + rng.uniform(-0.1, 0.1) * pitch,
            parameters.bridge_width, HEIGHT, rng,
        )
    ]  # fmt: skip


def _direction(
    road: Carriageway, count: int, parameters: TrafficSceneParameters, rng: np.random.Generator
) -> list[tuple[Actor, Actor]]:
    """Make the vehicles of one direction: shadow and body of each."""
    lane = Lane(0.0, SCALE, road.rightward)
    is_lorry = draw_lorries(count, parameters, rng)
    bodies = [_lorry(lane, rng) if large else any_car(lane, rng) for large in is_lorry]
    lengths = [body.size[0] / SCALE for body in bodies]
    flow = drive(lengths, is_lorry, parameters, WIDTH / SCALE, rng)
    return [
        body.on(_Way(road, body.size, flow.front[number], flow.lane[number]))
        for number, body in enumerate(bodies)
    ]


def _lorry(lane: Lane, rng: np.random.Generator) -> Vehicle:
    cab, load, stripe = (PAINTS[number] for number in rng.choice(len(PAINTS), 3, replace=False))
    return Vehicle(lorry(cab, load, stripe), lane)


class _Way:
    """Path of a vehicle through the flow; constant before its first and after its last frame."""

    def __init__(
        self, road: Carriageway, size: tuple[float, float], front: Array, lane: Array
    ) -> None:
        ground = [road.lane(number).ground for number in range(road.lanes)]
        x = front * SCALE
        self._left = (x - size[0] if road.rightward else WIDTH - x).tolist()
        foot = np.interp(lane, np.arange(road.lanes), ground)
        self._top = (foot - size[1]).tolist()
        self._size = size

    def __call__(self, frame: float) -> Box:
        """Give the box in `frame`."""
        index = min(max(round(frame), 0), len(self._left) - 1)
        return Box(self._left[index], self._top[index], *self._size)
