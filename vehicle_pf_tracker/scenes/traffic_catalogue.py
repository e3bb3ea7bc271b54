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
    parameter,
    parse_assignments,
    specs,
)
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.compositing import Image
from vehicle_pf_tracker.scenes.flow import Driver, Hold, simulate
from vehicle_pf_tracker.scenes.obstacles import bridge
from vehicle_pf_tracker.scenes.randomness import check_seed, stream
from vehicle_pf_tracker.scenes.roads import Carriageway, Lane, countryside
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.traffic import PAINTS, Vehicle, any_car
from vehicle_pf_tracker.scenes.traffic_scene import TrafficScene
from vehicle_pf_tracker.scenes.vehicles import lorry

WIDTH, HEIGHT = 640, 360
SCALE = 7.0
"""px per metre: a car is about 30 px long, a lorry 80."""
KMH = 3.6
"""km/h in a m/s."""
_TOP = 66
"""First row of asphalt, px."""
_MEDIAN = 34
"""Rows between the two carriageways, px."""
_FIRST = (0.0, 0.3)
"""Place of each lane's first vehicle in the beginning, in widths of the image: traffic comes in."""
_SPREAD = (0.88, 1.12)
"""Wanted speeds, in mean speeds."""
_LORRIES_AHEAD = 0.4
"""Place of the first lorry before the first cars, in widths of the image, where they overtake."""
_SLOW = 0.5
"""Speed in the lane of lorries: cars pass a lorry 10.6 m long in a second and a half."""
_LORRY_GAP = 2.5
"""Mean gap between lorries, in mean gaps: most cars pass one in the image."""
_GAPS = (0.5, 1.5)
"""Shortest and longest gap between two vehicles in the beginning, in mean gaps."""


@dataclass(frozen=True, slots=True)
class TrafficSceneParameters:
    """Parameters of every scene with many vehicles."""

    vehicles: int = parameter(
        20, "more vehicles in both directions together", minimum=2, maximum=80
    )
    directions: int = parameter(2, "1: all drive to the right", minimum=1, maximum=2)
    lanes: int = parameter(
        3, "more lanes of each direction: more vehicles beside each other", minimum=1, maximum=4
    )
    speed: float = parameter(
        55.0, "faster vehicles move farther between two frames",
        minimum=10.0, maximum=130.0, unit="km/h",
    )  # fmt: skip
    gap: float = parameter(
        18.0, "mean gap in the beginning; shorter ones pack vehicles", minimum=4.0, maximum=200.0,
        unit="m",
    )  # fmt: skip
    lorries: float = parameter(
        0.1,
        "share of lorries, which drive in the nearest lane and hide others",
        minimum=0.0,
        maximum=1.0,
    )
    bridges: int = parameter(
        0, "bridges, each of which hides every vehicle once", minimum=0, maximum=5
    )
    bridge_width: float = parameter(
        50.0, "wider bridges hide vehicles for longer", minimum=10.0, maximum=200.0, unit="px"
    )
    flow: str = parameter(
        "free", "queue: a red light holds all for 6 s; waves: short holds again and again",
        choices=("free", "queue", "waves"),
    )  # fmt: skip
    changing: bool = parameter(False, "drivers overtake slower ones")
    frames: int = parameter(400, "a longer scene", minimum=2, maximum=5000, unit="frames")
    noise: float = parameter(
        2.0, "more makes histograms differ from frame to frame",
        minimum=0.0, maximum=60.0, unit="levels of 255",
    )  # fmt: skip
    frame_rate: float = parameter(
        30.0, "more frames on the same way", minimum=5.0, maximum=240.0, unit="frames/s"
    )


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
    is_lorry = rng.permutation(np.arange(count) < round(parameters.lorries * count)).tolist()
    bodies = [_lorry(lane, rng) if large else any_car(lane, rng) for large in is_lorry]
    drivers = _drivers(bodies, is_lorry, parameters, rng)
    flow = simulate(
        drivers,
        parameters.lanes,
        parameters.frames,
        parameters.frame_rate,
        _holds(parameters),
        changing=parameters.changing,
    )
    return [
        body.on(_Way(road, body.size, flow.front[number], flow.lane[number]))
        for number, body in enumerate(bodies)
    ]


def _lorry(lane: Lane, rng: np.random.Generator) -> Vehicle:
    cab, load, stripe = (PAINTS[number] for number in rng.choice(len(PAINTS), 3, replace=False))
    return Vehicle(lorry(cab, load, stripe), lane)


def _drivers(
    bodies: list[Vehicle],
    is_lorry: list[bool],
    parameters: TrafficSceneParameters,
    rng: np.random.Generator,
) -> list[Driver]:
    """Place vehicles one behind the other; where there are lorries, the nearest lane is theirs."""
    slow = parameters.lanes - 1 if any(is_lorry) and parameters.lanes > 1 else parameters.lanes
    ahead = rng.uniform(*_FIRST, parameters.lanes + 1) * WIDTH / SCALE
    ahead[slow] += _LORRIES_AHEAD * WIDTH / SCALE
    drivers, car_count = [], 0
    for body, large in zip(bodies, is_lorry, strict=True):
        lane = slow % parameters.lanes if large else car_count % min(slow, parameters.lanes)
        car_count += not large
        length = body.size[0] / SCALE
        speed = parameters.speed / KMH * rng.uniform(*_SPREAD) * (_SLOW if lane == slow else 1.0)
        drivers.append(Driver(lane, float(ahead[lane]), length, float(speed)))
        gap = parameters.gap * rng.uniform(*_GAPS) * (_LORRY_GAP if lane == slow else 1.0)
        ahead[lane] -= length + gap
    return drivers


def _holds(parameters: TrafficSceneParameters) -> tuple[Hold, ...]:
    visible = WIDTH / SCALE
    if parameters.flow == "queue":
        return (Hold(0.75 * visible, 2.0, 8.0),)
    if parameters.flow == "waves":
        return tuple(Hold(0.85 * visible, begin, begin + 2.5) for begin in range(1, 200, 6))
    return ()


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
