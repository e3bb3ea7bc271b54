# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes with many vehicles in perspective: a road seen from a gantry or a mast.

Vehicles grow as they come, and hide what drives behind them on the road.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from laboratory.scenes.flow import TrafficSceneParameters, draw_lorries, drive
from laboratory.scenes.perspective import RoadCamera, RoadVehicle, looking
from laboratory.scenes.road_ground import RoadMarks, ground_picture
from laboratory.scenes.traffic_scene import TrafficScene
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.road import format_pairs
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import Pair, RoadPlane
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.lane_traffic import CAR_PAINTS
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.solids import Face
from vehicle_pf_tracker.scenes.vehicle_parts import tinted
from vehicle_pf_tracker.scenes.vehicles import car, lorry, saloon, van

WIDTH, HEIGHT = 640, 360
"""Size of the images, px: that of a common stream of a traffic camera."""
LANE_WIDTH = 3.5
"""Width of a lane, m: a motorway."""
MEDIAN = 4.0
"""Width between the two carriageways, m."""
NEAR, FAR = 33.0, 140.0
"""Stretch (y) that is in the image, m: a car is 50 px wide there, and 12 px."""
_LOWEST = 8.0
"""Least y of a vehicle's middle, m: below the image, and all of a lorry is before the camera."""
_CREST = 170.0
"""Largest y of a vehicle's middle that is shown, m: there the road goes over a crest."""
_AHEAD = 110.0
"""Distance that the camera looks at, m: the horizon is in the image, the near end at its border."""
_SHOULDER = 1.0
"""Asphalt beside the outer lines, m."""
_CARS = (
    (car, (0.68, 2.95)),
    (saloon, (0.85, 3.7)),
    (saloon, (0.85, 3.7)),
    (van, (1.0, 4.5)),
)
"""Makers and axles (m from the rear) of the kinds of vehicles to choose from."""
_ROAD_FROM = 0.5
"""Row of the farthest pairs of a road, of the image's height: clearly below its horizon."""
_LORRY_AXLES = (1.0, 2.2, 7.1, 9.4)
"""Axles of a lorry, m from the rear."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PerspectiveScene(TrafficScene):
    """Traffic in perspective, with the exact map from pixels to the road."""

    road: RoadPlane


class OnRoad:
    """A vehicle of the flow, on the plane of the road.

    Parameters
    ----------
    faces, axles : sequence of Face, sequence of float
        The vehicle as seen from its near side, and places of its axles, m from the rear.
    """

    def __init__(self, faces: Sequence[Face], axles: Sequence[float]) -> None:
        corners = np.concatenate([np.asarray(face.points) for face in faces])
        self.faces = faces
        self.axles = axles
        self.length, self.width = np.ptp(corners[:, :2], axis=0).tolist()
        self.x = self.y = np.zeros(1)

    def place(self, x: Array, y: Array) -> None:
        """Set its way: the middle's position in each frame, m."""
        self.x = x
        # Beyond the crest it waits below the image, where nobody sees it.
        self.y = np.where(y < _CREST, np.maximum(y, _LOWEST), _LOWEST)

    def at(self, frame: float) -> tuple[float, float]:
        """Give its middle's position in `frame`; constant before the first and after the last.

        It leaps from one end of the stretch to the other, with no way between.
        """
        index = int(min(max(frame, 0), len(self.x) - 1))
        after = min(index + 1, len(self.x) - 1)
        share = frame - index
        # Nobody drives 3.5 m in a frame (380 km/h at 30 frames/s): that is a leap.
        if not 0 < share < 1 or abs(self.y[after] - self.y[index]) > LANE_WIDTH:
            return float(self.x[index]), float(self.y[index])
        x, y = ((1 - share) * way[index] + share * way[after] for way in (self.x, self.y))
        return float(x), float(y)


@dataclass(frozen=True, slots=True)
class PerspectiveParameters(TrafficSceneParameters):
    """Parameters of traffic in perspective, which has no bridges."""

    view: str = parameter(
        "gantry",
        "gantry: from over the road, the last lane is the outer one; mast: from the middle of the "
        "road, the last lane is the inner one",
        choices=("gantry", "mast"),
    )


def perspective_scene(parameters: PerspectiveParameters, seed: int) -> PerspectiveScene:
    """Make traffic seen from over the road.

    Raises
    ------
    InputError
        If there are to be bridges.
    """
    if parameters.bridges:
        raise InputError("a scene in perspective has no bridges; leave out the setting bridges")
    camera = camera_over(parameters, seed)
    # One more of those that come, if the number is odd.
    count = parameters.vehicles if parameters.directions == 1 else (parameters.vehicles + 1) // 2
    coming = _direction(count, True, parameters, stream(seed, "coming traffic"))
    going = _direction(
        parameters.vehicles - count, False, parameters, stream(seed, "going traffic")
    )
    vehicles = [*coming, *going]
    return PerspectiveScene(
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=parameters.frames,
        backdrop=lambda: ground_picture(
            camera, (WIDTH, HEIGHT), _marks(parameters), stream(seed, "ground")
        ),
        vehicles=tuple(
            actors_of(vehicle, -1 if number < count else 1, camera)
            for number, vehicle in enumerate(vehicles)
        ),
        obstacles=(),
        camera=Camera(parameters.noise, seed),
        order=order_of(vehicles, float(camera.pose.position[0])),
        road=camera.plane,
    )


def road_file(scene: PerspectiveScene) -> str:
    """Return a parameter file with pairs of the road: a grid below the horizon."""
    # Nine pairs; four would do for a plane.
    columns, rows = np.meshgrid(
        np.linspace(0, scene.width, 3), np.linspace(_ROAD_FROM, 1, 3) * scene.height
    )
    pixels = np.stack([columns, rows], axis=-1).reshape(-1, 2)
    pairs = tuple(
        Pair((u, v), (x, y))
        for (u, v), (x, y) in zip(pixels.tolist(), scene.road.to_road(pixels).tolist(), strict=True)
    )
    return f'/**:\n  ros__parameters:\n    road.pairs: "{format_pairs(pairs)}"\n'


def camera_over(parameters: PerspectiveParameters, seed: int) -> RoadCamera:
    """Return the camera of the scene of this seed."""
    rng = stream(seed, "camera over traffic")
    focal = float(rng.uniform(950, 1050))
    lens = Lens((focal, focal), (WIDTH / 2 - 0.5, HEIGHT / 2 - 0.5))
    middle = float(
        np.mean(
            [lane for way in (-1, 1)[: parameters.directions] for lane in _lanes(way, parameters)]
        )
    )
    # A mast stands inside of the inner lanes: seen from there, lorries in them hide the others.
    x = float(rng.uniform(3, 5)) if parameters.view == "mast" else middle
    place = (x + float(rng.uniform(-1, 1)), 0.0, float(rng.uniform(8.2, 9)))
    return RoadCamera(lens, looking(place, (middle, _AHEAD)))


def _lanes(way: int, parameters: PerspectiveParameters) -> list[float]:
    """Middles (x, m) of the lanes of one direction, the first the inner one but for a mast."""
    lanes = [way * (MEDIAN / 2 + LANE_WIDTH * (number + 0.5)) for number in range(parameters.lanes)]
    return lanes[::-1] if parameters.view == "mast" else lanes


def _marks(parameters: PerspectiveParameters) -> RoadMarks:
    # The median is x = 0; the lanes of both directions are mirror images.
    inner = MEDIAN / 2
    outer = MEDIAN / 2 + LANE_WIDTH * parameters.lanes
    ways = (-1, 1)[: parameters.directions]
    between = [inner + LANE_WIDTH * number for number in range(1, parameters.lanes)]
    return RoadMarks(
        tar=tuple(
            (
                min(way * (inner - _SHOULDER), way * (outer + _SHOULDER)),
                max(way * (inner - _SHOULDER), way * (outer + _SHOULDER)),
            )
            for way in ways
        ),
        dashed=tuple(way * x for way in ways for x in between),
        solid=tuple(way * x for way in ways for x in (inner, outer)),
    )


def _direction(
    count: int, coming: bool, parameters: PerspectiveParameters, rng: np.random.Generator
) -> list[OnRoad]:
    """Make the vehicles of one direction with their ways; those that come drive on the left."""
    is_lorry = draw_lorries(count, parameters, rng)
    vehicles = [_lorry(rng) if large else any_car(rng) for large in is_lorry]
    lengths = [vehicle.length for vehicle in vehicles]
    flow = drive(lengths, is_lorry, parameters, FAR - NEAR, rng)
    lanes = _lanes(-1 if coming else 1, parameters)
    for number, vehicle in enumerate(vehicles):
        # Between two lanes during a change, as the flow has it.
        x = np.interp(flow.lane[number], np.arange(len(lanes)), lanes)
        middle = flow.front[number] - vehicle.length / 2
        vehicle.place(x, FAR - middle if coming else NEAR + middle)
    return vehicles


def any_car(rng: np.random.Generator) -> OnRoad:
    """Draw a car or a van."""
    paint = tinted(CAR_PAINTS[rng.integers(len(CAR_PAINTS))], rng.uniform(0.9, 1.08))
    maker, axles = _CARS[rng.integers(len(_CARS))]
    return OnRoad(maker(paint), axles)


def _lorry(rng: np.random.Generator) -> OnRoad:
    # Three different colours: a lorry of one would look like a box.
    cab, load, stripe = (
        CAR_PAINTS[number] for number in rng.choice(len(CAR_PAINTS), 3, replace=False)
    )
    # From the side no end of the box is seen.
    ends = [
        Face(((x, 0.0, 1.1), (x, 0.0, 4.0), (x, 2.5, 4.0), (x, 2.5, 1.1)), load) for x in (0, 8.3)
    ]
    return OnRoad([*ends, *lorry(cab, load, stripe)], _LORRY_AXLES)


def actors_of(vehicle: OnRoad, way: int, camera: RoadCamera) -> tuple[Actor, Actor]:
    """Return shadow and body of a vehicle that drives along y (way 1) or against it (-1)."""
    heading = way * math.pi / 2
    return RoadVehicle(vehicle.faces, vehicle.axles, heading, vehicle.at, camera).actors()


def order_of(vehicles: Sequence[OnRoad], camera_x: float) -> Callable[[int], list[int]]:
    """Order of painting, far to near.

    Of two vehicles one behind the other the farther one is painted first, of two side by side
    the one that is farther to the side: the plane between them has the camera on the other side.
    """

    def order(index: int) -> list[int]:
        x, y = np.array([vehicle.at(index) for vehicle in vehicles]).reshape(-1, 2).T
        aside = np.abs(x - camera_x) - [vehicle.width / 2 for vehicle in vehicles]
        half = np.array([vehicle.length / 2 for vehicle in vehicles])
        # First: all of one is farther than all of the other along the road.
        behind = y[:, np.newaxis] - half[:, np.newaxis] >= y + half
        # Else by the side, for those that overlap along the road.
        beside = (~behind & ~behind.T) & (aside[:, np.newaxis] > aside)
        first = behind | beside
        # The order by repeated choice: of those that are left, one that waits for nobody else.
        left = list(range(len(vehicles)))
        ordered = []
        while left:
            waits = first[np.ix_(left, left)].sum(axis=0)
            # Zero but for a circle of vehicles, in which none hides all the others.
            chosen = left[min(range(len(left)), key=lambda n: (waits[n], -y[left[n]]))]
            ordered.append(chosen)
            left.remove(chosen)
        return ordered

    return order
