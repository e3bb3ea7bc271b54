# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A scene with many vehicles, and the exact truth about every one of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from laboratory.scenes.flow import TrafficSceneParameters, draw_lorries, drive
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.compositing import PixelWindow
from vehicle_pf_tracker.scenes.lane_traffic import CAR_PAINTS, Lane, LaneVehicle, any_car
from vehicle_pf_tracker.scenes.obstacles import bridge
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.roads import Carriageway, countryside
from vehicle_pf_tracker.scenes.scene import Actor, Path, Stage
from vehicle_pf_tracker.scenes.vehicles import lorry

PX_PER_METRE = 7.0
"""px per metre: a car is about 30 px long, a lorry 80."""
_TOP = 66
"""First row of asphalt, px: room for the hedge, which `countryside` ends 45 rows above."""
_MEDIAN = 34
"""Rows between the two carriageways, px: room for the guard rail of 12."""
SCENERY = "scene"
"""Name, in place of an identity, of whatever hides a vehicle and is no vehicle."""
WIDTH, HEIGHT = 640, 360
"""Size of the images, px: that of a common stream of a traffic camera."""


@dataclass(frozen=True, slots=True)
class VehicleTruth:
    """Truth about one vehicle in one frame.

    Attributes
    ----------
    identity : int
        Number of the vehicle, from 1.
    box : Box
        Box of the vehicle, cut at the image's borders, px.
    whole : Box
        Whole box of the vehicle, px.
    visible : float
        Share of it that is not hidden by others, of what is inside the image.
    depth : int
        Number of vehicles in the image that are nearer.
    hidden_by : int or "scene" or None
        Identity of the vehicle that hides most of it, "scene" if that is an obstacle.
    hidden_share : float
        Share that this one hides.
    """

    identity: int
    box: Box
    whole: Box
    visible: float
    depth: int = 0
    hidden_by: int | str | None = None
    hidden_share: float = 0.0


@dataclass(frozen=True, slots=True)
class TrafficScene(Stage):
    """A scene with many vehicles, whose camera must not move.

    Attributes
    ----------
    vehicles : tuple of (Actor, Actor)
        Shadow and body of each vehicle.
    obstacles : tuple of Actor
        What stands in front of all vehicles, in painting order.
    order : callable or None
        Indices of the vehicles of a frame, far to near; None: the lower a body stands, the
        nearer it is.
    """

    vehicles: tuple[tuple[Actor, Actor], ...]
    obstacles: tuple[Actor, ...]
    order: Callable[[int], list[int]] | None = None

    def painted(self, index: int) -> Iterable[Actor]:
        """Give all shadows, then all bodies, each far to near, and the obstacles."""
        order = self._far_to_near(index)
        parts = (self.vehicles[number][part] for part in (0, 1) for number in order)
        return *parts, *self.obstacles

    def frames(self) -> Iterator[tuple[Frame, tuple[VehicleTruth, ...]]]:
        """Render every frame in order, with its truth."""
        return zip(self.images(), map(self.truth, range(self.frame_count)), strict=True)

    def truth(self, index: int) -> tuple[VehicleTruth, ...]:
        """Exact truth about every vehicle in the image of frame `index`, by identity."""
        # Near to far: whatever may hide a vehicle is known when it is its turn.
        inside = [
            (number, box, whole)
            for number in reversed(self._far_to_near(index))
            if (box := self._cut(whole := self.vehicles[number][1].path(index))) is not None
        ]
        nearer: list[tuple[int | str, Actor]] = [(SCENERY, actor) for actor in self.obstacles]
        found = []
        for depth, (number, box, whole) in enumerate(inside):
            body = self.vehicles[number][1]
            visible, hidden_by, share = self._visible(body, nearer, index)
            found.append(VehicleTruth(number + 1, box, whole, visible, depth, hidden_by, share))
            nearer.append((number + 1, body))
        return tuple(sorted(found, key=lambda one: one.identity))

    def _far_to_near(self, index: int) -> list[int]:
        if self.order is not None:
            return self.order(index)

        def foot(number: int) -> float:
            box = self.vehicles[number][1].path(index)
            return box.y + box.height

        return sorted(range(len(self.vehicles)), key=foot)

    def _cut(self, box: Box) -> Box | None:
        left = max(box.x, 0.0)
        top = max(box.y, 0.0)
        right = min(box.x + box.width, float(self.width))
        bottom = min(box.y + box.height, float(self.height))
        inside = left < right and top < bottom
        return Box(left, top, right - left, bottom - top) if inside else None

    def _visible(
        self, body: Actor, nearer: list[tuple[int | str, Actor]], index: int
    ) -> tuple[float, int | str | None, float]:
        """Share in sight; what hides most of the rest, and its share."""
        box = body.path(index)
        window = PixelWindow.of(box, self.width, self.height)
        # Of the silhouette, not of the box; see `Scene`.
        own = body.seen(index).coverage(box, window)
        total = float(own.sum())
        if total <= 0:  # a corner of the box may hold nothing of the silhouette
            return 0.0, None, 0.0
        seen = own
        shares: dict[int | str, float] = {}
        for name, actor in nearer:
            place = actor.path(index)
            if actor.hides and place.iou(box) > 0:
                cover = actor.seen(index).coverage(place, window)
                seen = seen * (1 - cover)
                # By each alone: what two hide together counts for both, and the largest is named.
                shares[name] = shares.get(name, 0.0) + float((own * cover).sum()) / total
        # Rounded, as sums of floats make a free vehicle look 1e-16 hidden.
        visible = round(float(seen.sum()) / total, 9)
        most = max(shares, key=lambda name: shares[name], default=None)
        if most is None or shares[most] <= 0:
            return visible, None, 0.0
        return visible, most, min(round(shares[most], 9), 1.0)


def traffic(parameters: TrafficSceneParameters, seed: int) -> TrafficScene:
    """Make traffic in the view from beside the road."""
    far = Carriageway(_TOP, parameters.lanes, PX_PER_METRE, rightward=True)
    near = Carriageway(far.rows.stop + _MEDIAN, parameters.lanes, PX_PER_METRE, rightward=False)
    count = parameters.vehicles if parameters.directions == 1 else (parameters.vehicles + 1) // 2
    vehicles = [
        *_direction(far, count, parameters, stream(seed, "far traffic")),
        *_direction(near, parameters.vehicles - count, parameters, stream(seed, "near traffic")),
    ]
    return TrafficScene(
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=parameters.frames,
        backdrop=lambda: countryside((HEIGHT, WIDTH), (far, near), stream(seed, "backdrop")),
        vehicles=tuple(vehicles),
        obstacles=tuple(_bridges(parameters, seed)),
        camera=Camera(parameters.noise, seed),
    )


def _bridges(parameters: TrafficSceneParameters, seed: int) -> list[Actor]:
    rng = stream(seed, "bridges")
    pitch = WIDTH / (parameters.bridges + 1)
    return [
        actor
        for number in range(1, parameters.bridges + 1)
        for actor in bridge(
            number * pitch - parameters.bridge_width / 2 + rng.uniform(-0.1, 0.1) * pitch,
            parameters.bridge_width,
            HEIGHT,
            rng,
        )
    ]


def _direction(
    road: Carriageway, count: int, parameters: TrafficSceneParameters, rng: np.random.Generator
) -> list[tuple[Actor, Actor]]:
    """Make the vehicles of one direction: shadow and body of each."""
    lane = Lane(0.0, PX_PER_METRE, road.rightward)
    is_lorry = draw_lorries(count, parameters, rng)
    bodies = [_lorry(lane, rng) if large else any_car(lane, rng) for large in is_lorry]
    # As long as it is drawn: bumpers of two vehicles touch in the image when they do in the flow.
    lengths = [body.size[0] / PX_PER_METRE for body in bodies]
    flow = drive(lengths, is_lorry, parameters, WIDTH / PX_PER_METRE, rng)
    return [
        body.on(_way(road, body.size, flow.front[number], flow.lane[number]))
        for number, body in enumerate(bodies)
    ]


def _lorry(lane: Lane, rng: np.random.Generator) -> LaneVehicle:
    cab, load, stripe = (
        CAR_PAINTS[number] for number in rng.choice(len(CAR_PAINTS), 3, replace=False)
    )
    return LaneVehicle(lorry(cab, load, stripe), lane)


def _way(road: Carriageway, size: tuple[float, float], front: Array, lane: Array) -> Path:
    """Make the path of a vehicle; constant before its first and after its last frame."""
    x = front * PX_PER_METRE
    # The front is the right edge of a vehicle that drives to the right, else the left edge.
    left = x - size[0] if road.rightward else WIDTH - x
    ground = [road.lane(number).ground for number in range(road.lanes)]
    # `lane` has fractions during a change, and so has the row.
    top = np.interp(lane, np.arange(road.lanes), ground) - size[1]
    boxes = [Box(*corner, *size) for corner in zip(left.tolist(), top.tolist(), strict=True)]
    return lambda frame: boxes[min(max(round(frame), 0), len(boxes) - 1)]
