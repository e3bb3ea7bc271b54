# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A road in perspective: a vehicle comes or goes along it at a known speed in km/h.

The camera stands on a mast or hangs from a gantry; its place, view and lens differ between seeds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from laboratory.scenes.perspective import Drive, RoadCamera, RoadVehicle, looking
from laboratory.scenes.road_ground import RoadMarks, ground_picture
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.drive import TARGET_PAINTS
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.vehicles import car, saloon, suv

WIDTH, HEIGHT = 640, 480
"""Size of the images, px: that of the other scenes with one target."""
LANE_WIDTH = 3.5
"""Width of a lane, m: a main road."""
LANES = (-LANE_WIDTH, 0.0, LANE_WIDTH)
"""Middles of the lanes (x), m; the target drives in the middle one."""
NEAR, FAR = 22.0, 70.0
"""Stretch (y) that the target is seen on, m: a car is 80 px wide there, and 25 px."""
LONGEST = 150
"""Most frames: slow vehicles are seen on a part of the stretch, near the camera."""
KMH = 3.6
"""km/h in a m/s."""

_VEHICLES = {
    "car": (car, (0.68, 2.95)),
    "saloon": (saloon, (0.85, 3.7)),
    "suv": (suv, (0.9, 3.6)),
}
"""Maker and axles (m from the rear) of each kind of vehicle."""
# The barrel is that of a wide lens; its tangential parts are those of a cheap mount.
_LENSES = {
    "none": ("none", ()),
    "barrel": ("plumb_bob", (-0.28, 0.09, 0.0004, -0.0006, 0.0)),
}
_EDGE = 1.5 * LANE_WIDTH
"""Distance of the outer lines from the middle of the road, m."""
_MARKS = RoadMarks(
    tar=((-_EDGE - 1, _EDGE + 1),),
    dashed=(-LANE_WIDTH / 2, LANE_WIDTH / 2),
    solid=(-_EDGE, _EDGE),
)


@dataclass(frozen=True, slots=True)
class RoadSceneParameters:
    """Parameters of the road in perspective."""

    speed: float = parameter(
        70.0, "faster vehicles move farther between two frames, and the video gets shorter",
        bounds=(20.0, 130.0), unit="km/h",
    )  # fmt: skip
    vehicle: str = parameter("car", "the kind of vehicle that is followed", choices=_VEHICLES)
    heading: str = parameter(
        "coming",
        "coming vehicles grow in the image, going ones shrink",
        choices=("coming", "going"),
    )
    mount: str = parameter(
        "gantry", "over the road, or on a mast beside it that shows vehicles from the side",
        choices=("gantry", "mast"),
    )  # fmt: skip
    lens: str = parameter("none", "barrel bends straight lines outwards", choices=_LENSES)
    noise: float = parameter(
        2.0, "more makes histograms differ from frame to frame",
        bounds=(0.0, 60.0), unit="levels of 255",
    )  # fmt: skip
    frame_rate: float = parameter(
        25.0, "more frames on the same way", bounds=(5.0, 240.0), unit="frames/s"
    )


def road(parameters: RoadSceneParameters, seed: int) -> Scene:
    """Make the scene."""
    rng = stream(seed, "road in perspective")
    camera = camera_of(parameters, seed)
    # Metres from one frame to the next.
    step = parameters.speed / KMH / parameters.frame_rate
    count = min(int((FAR - NEAR) / step) + 1, LONGEST)
    # Drivers do not keep exactly to the middle of their lane.
    shift = float(rng.uniform(-0.3, 0.3))
    coming = parameters.heading == "coming"
    # One that comes ends at `NEAR`, also where `LONGEST` cuts its way: there it is largest.
    start, way = (NEAR + (count - 1) * step, -step) if coming else (NEAR, step)
    target = _vehicle(parameters.vehicle, (shift, start), way, camera, rng)
    others = _others(way, camera, rng)
    return Scene(
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=count,
        backdrop=lambda: ground_picture(camera, (WIDTH, HEIGHT), _MARKS, stream(seed, "ground")),
        actors=(*others, *target),
        target=len(others) + 1,
        camera=Camera(parameters.noise, seed),
    )


def camera_of(parameters: RoadSceneParameters, seed: int) -> RoadCamera:
    """Return the camera of the scene of this seed."""
    # A stream of its own: `road_speed` needs the camera without the rest of the scene.
    rng = stream(seed, "camera over a road")
    model, coefficients = _LENSES[parameters.lens]
    # A field of view of about 35 degrees: a lens for a stretch of road, not for a panorama.
    focal = float(rng.uniform(950, 1050))
    # Pixel centres are at whole numbers, so that the middle of the image is half a pixel less.
    lens = Lens((focal, focal), (WIDTH / 2 - 0.5, HEIGHT / 2 - 0.5), model, coefficients)
    if parameters.mount == "gantry":
        place = (float(rng.uniform(-3, 3)), 0.0, float(rng.uniform(6.5, 9)))
        return RoadCamera(lens, looking(place, (0.0, float(rng.uniform(30, 34)))))
    side = float(rng.choice([-1.0, 1.0]))
    # 10 to 13 m aside: vehicles are seen from their side, too.
    place = (side * float(rng.uniform(10, 13)), 4.0, float(rng.uniform(7, 10)))
    return RoadCamera(lens, looking(place, (0.0, float(rng.uniform(34, 38)))))


def _vehicle(
    kind: str,
    start: tuple[float, float],
    step: float,
    camera: RoadCamera,
    rng: np.random.Generator,
) -> tuple[Actor, Actor]:
    """Make a vehicle that is at `start` in frame 0 and moves by `step` along y, m per frame."""
    maker, axles = _VEHICLES[kind]
    faces = maker(TARGET_PAINTS[int(rng.integers(len(TARGET_PAINTS)))])
    drive: Drive = lambda frame: (start[0], start[1] + step * frame)  # noqa: E731 - one expression
    heading = math.copysign(math.pi / 2, step)
    return RoadVehicle(faces, axles, heading, drive, camera).actors()


def _others(way: float, camera: RoadCamera, rng: np.random.Generator) -> list[Actor]:
    """Make the vehicles of the other lanes, far to near: they never hide the target."""
    # Near where the target begins, so that all are in view together.
    first = FAR if way < 0 else NEAR
    places = [(lane, first + float(rng.uniform(-10, 10))) for lane in (LANES[0], LANES[2])]
    actors: list[Actor] = []
    for place in sorted(places, key=lambda place: -place[1]):
        kind = list(_VEHICLES)[int(rng.integers(len(_VEHICLES)))]
        pace = way * float(rng.uniform(0.8, 1.2))
        actors += _vehicle(kind, place, pace, camera, rng)
    return actors
