# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes of a road close to a shaking camera: each vehicle is in view for about a second.

The borders cut both of its ends, it moves by a tenth of its length or more per frame, and it is
blurred. The detector `brief` misses two of three vehicles, and reports the same spots of the
background again and again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from laboratory.scenes.flow import TrafficSceneParameters, drive
from laboratory.scenes.perspective import RoadCamera, looking
from laboratory.scenes.road_ground import RoadMarks, ground_picture
from laboratory.scenes.simulated_detector import SimulatedDetector, false_alarm
from laboratory.scenes.traffic_perspective import LANE_WIDTH, OnRoad, actors_of, any_car, order_of
from laboratory.scenes.traffic_scene import TrafficScene, VehicleTruth
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.scenes.cameras import SHAKE_MARGIN, Disturbance, OutdoorCamera
from vehicle_pf_tracker.scenes.compositing import Image
from vehicle_pf_tracker.scenes.random_streams import stream

WIDTH, HEIGHT = 384, 256
"""Size of the images, px: small, as vehicles are large in them."""
_FIELD = math.radians(44)
"""Field of view: that of a common camera without zoom."""
_EXPOSURE = (0.0, 0.4)
"""Moments of a frame that are averaged, in frame periods: the shutter is open for half of one."""
_LONGEST = 5.5
"""Length of the longest vehicle, m, and room outside of the image where a vehicle begins."""
_CELLS = 50_000
"""Cells that a vehicle is drawn with at most: large, moving ones are blurred anyway."""
_SPOTS = 4
"""Standing spots of the background that are often taken for vehicles, with low scores."""
_SPOT_RATE = 0.4
"""Share of the frames in which a standing spot is taken for a vehicle."""


class SpottingDetector(SimulatedDetector):
    """A detector that also reports standing spots of the background."""

    def detect(
        self, truths: Sequence[Sequence[VehicleTruth]], size: tuple[int, int], seed: int
    ) -> Array:
        """Simulate the detector on all frames of a scene."""
        spots = (
            _standing_spot(len(truths), size, stream(seed, "spot", spot)) for spot in range(_SPOTS)
        )
        return np.vstack([SimulatedDetector.detect(self, truths, size, seed), *spots])


def _standing_spot(frames: int, size: tuple[int, int], rng: np.random.Generator) -> Array:
    """Report a place of the background in every second or third frame, about the same box."""
    # About the same box each time, by 1 px: what a network takes for a vehicle does not move.
    box, _ = false_alarm(size, rng)
    seen = 1 + np.flatnonzero(rng.uniform(size=frames) < _SPOT_RATE)
    rows = [
        [float(frame), *(box + rng.normal(0.0, 1.0, 4)).tolist(), float(rng.uniform(0.05, 0.3))]
        for frame in seen.tolist()
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 6)


BRIEF = SpottingDetector(misses=0.67, miss_length=2.0, false_alarms=0.3, noise=0.06)
"""A small network before close, blurred vehicles."""


@dataclass(frozen=True, slots=True)
class CloseParameters(TrafficSceneParameters):
    """Parameters of a close road, which has no bridges, lorries or red lights."""

    shake: float = parameter(3.0, "the camera shakes farther", bounds=(0.0, 10.0), unit="px")


@dataclass(frozen=True, slots=True, kw_only=True)
class CloseScene(TrafficScene):
    """Traffic before a camera that shakes; vehicles and backdrop are on a larger stage."""

    camera: OutdoorCamera

    def frames(self) -> Iterator[tuple[Frame, tuple[VehicleTruth, ...]]]:
        """Render every frame in order, with its truth."""
        backdrop = self.backdrop()
        for index in range(self.frame_count):
            # The mean of a few moments is the blur of an open shutter.
            moments = [self._painted(backdrop, index + at) for at in _EXPOSURE]
            picture: Image = np.mean(moments, axis=0).astype(np.float32)
            yield self.camera.capture(picture, index), self.truth(index)

    def truth(self, index: int) -> tuple[VehicleTruth, ...]:
        """Exact truth about every vehicle in the image of frame `index`, by identity."""
        # On the stage, as the shake brings parts of its margin into the image; cut afterwards.
        left, top = self.camera.offset(index)
        stage = replace(
            self, width=self.width + 2 * SHAKE_MARGIN, height=self.height + 2 * SHAKE_MARGIN
        )
        moved = [
            (one, Box(one.whole.x - left, one.whole.y - top, one.whole.width, one.whole.height))
            for one in TrafficScene.truth(stage, index)
        ]
        return tuple(
            replace(one, box=box, whole=whole)
            for one, whole in moved
            if (box := self._cut(whole)) is not None
        )

    def _painted(self, backdrop: Image, moment: float) -> Image:
        picture: Image = backdrop.copy()
        # One order for a moment between two frames: nobody overtakes within half a frame.
        order = self._far_to_near(round(moment))
        for part in (0, 1):
            for number in order:
                self.vehicles[number][part].paint(picture, moment)
        return picture


def close_scene(parameters: CloseParameters, seed: int) -> CloseScene:
    """Make traffic on a road beside a camera, which looks across it."""
    rng = stream(seed, "camera beside traffic")
    aside = float(rng.uniform(6.0, 9.0))
    angle = math.radians(float(rng.uniform(42, 62)))
    size = (WIDTH + 2 * SHAKE_MARGIN, HEIGHT + 2 * SHAKE_MARGIN)
    focal = WIDTH / 2 / math.tan(_FIELD / 2)
    lens = Lens((focal, focal), (size[0] / 2 - 0.5, size[1] / 2 - 0.5))
    # The camera looks at a point of the road 12 m away, at its angle to the road.
    ahead = 12.0
    look_at = (ahead * math.sin(angle), ahead * math.cos(angle))
    camera = RoadCamera(lens, looking((0.0, 0.0, float(rng.uniform(4.5, 7.0))), look_at), _CELLS)
    # Where the edges of the view meet the far and the near side of the road, and a vehicle more.
    far = (aside + 2 * LANE_WIDTH) / math.tan(angle - _FIELD / 2) + _LONGEST
    near = aside / math.tan(angle + _FIELD / 2) - _LONGEST
    half = (parameters.vehicles + 1) // 2
    # Traffic keeps to the right: those that come are in the nearer lane.
    ways = ((half, True, 0.5), (parameters.vehicles - half, False, 1.5))
    vehicles = [
        vehicle
        for count, coming, lane in ways
        for vehicle in _direction(
            count, coming, aside + LANE_WIDTH * lane, (near, far), parameters,
            stream(seed, f"close traffic {coming}"),
        )
    ]  # fmt: skip
    middle = aside + LANE_WIDTH
    marks = RoadMarks(
        tar=((aside - 1, aside + 2 * LANE_WIDTH + 1),),
        dashed=(middle,),
        solid=(aside, aside + 2 * LANE_WIDTH),
    )
    return CloseScene(
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=parameters.frames,
        backdrop=lambda: ground_picture(camera, size, marks, stream(seed, "ground")),
        vehicles=tuple(
            actors_of(vehicle, -1 if number < half else 1, camera)
            for number, vehicle in enumerate(vehicles)
        ),
        obstacles=(),
        camera=OutdoorCamera(Disturbance(parameters.noise, parameters.shake, 0.0), seed),
        order=order_of(vehicles, 0.0),
    )


def _direction(
    count: int,
    coming: bool,
    x: float,
    stretch: tuple[float, float],
    parameters: CloseParameters,
    rng: np.random.Generator,
) -> list[OnRoad]:
    """Make the vehicles of one lane (x, m), which drive through the stretch (y, m) in view."""
    near, far = stretch
    vehicles = [any_car(rng) for _ in range(count)]
    lengths = [vehicle.length for vehicle in vehicles]
    flow = drive(lengths, [False] * count, replace(parameters, lanes=1), far - near, rng)
    for number, vehicle in enumerate(vehicles):
        middle = flow.front[number] - vehicle.length / 2
        y = far - middle if coming else near + middle
        # Outside of the view all wait at its far end: near the camera they would be behind it.
        vehicle.x = np.full(len(y), x)
        vehicle.y = np.where((y > near) & (y < far), y, far + 9)
    return vehicles
