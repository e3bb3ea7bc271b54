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

"""A scene with many vehicles, and the exact truth about every one of them.

Settings of the scenes with many vehicles.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.scenes.compositing import Image, PixelWindow, overlap, paint
from vehicle_pf_tracker.scenes.scene import Actor, Eye

SCENERY = "scene"
"""Stands for whatever hides a vehicle and is none."""


@dataclass(frozen=True, slots=True)
class VehicleTruth:
    """Truth about one vehicle in one frame.

    Attributes
    ----------
    identity : int
        Number of the vehicle, from 1.
    box : Box
        Its box, cut at the image's borders, px.
    whole : Box
        Its whole box.
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
class TrafficScene:
    """Synthetic traffic; the same scene, parameters and seed give bit-identical frames.

    Attributes
    ----------
    name : str
        Name in the catalogue.
    width, height : int
        Image size in px.
    frame_rate : float
        Frames per second.
    frame_count : int
        Number of frames.
    backdrop : callable
        Draws what never moves and hides nothing.
    vehicles : tuple of (Actor, Actor)
        Shadow and body of each vehicle.
    obstacles : tuple of Actor
        What stands in front of all vehicles, in painting order.
    camera : Eye
        Takes the picture; it must not move.
    order : callable or None
        Indices of the vehicles of a frame, far to near; None: the lower a body stands, the
        nearer it is.
    road : RoadPlane or None
        Exact map from pixels to the road, where the scene is in perspective.
    """

    name: str
    width: int
    height: int
    frame_rate: float
    frame_count: int
    backdrop: Callable[[], Image]
    vehicles: tuple[tuple[Actor, Actor], ...]
    obstacles: tuple[Actor, ...]
    camera: Eye
    order: Callable[[int], list[int]] | None = None
    road: RoadPlane | None = None

    def frames(self) -> Iterator[tuple[Frame, tuple[VehicleTruth, ...]]]:
        """Render every frame in order, with its truth."""
        backdrop = self.backdrop()
        for index in range(self.frame_count):
            picture = backdrop.copy()
            order = self._far_to_near(index)
            shadows = [self.vehicles[number][0] for number in order]
            bodies = [self.vehicles[number][1] for number in order]
            for actor in (*shadows, *bodies, *self.obstacles):
                box = actor.path(index)
                if not PixelWindow.of(box, self.width, self.height).empty:
                    paint(picture, actor.seen(index), box)
            yield self.camera.capture(picture, index), self.truth(index)

    def truth(self, index: int) -> tuple[VehicleTruth, ...]:
        """Exact truth about every vehicle in the image of frame `index`, by identity."""
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
        left, top = max(box.x, 0.0), max(box.y, 0.0)
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
        own = body.seen(index).coverage(box, window)
        total = float(own.sum())
        if total <= 0:  # a corner of the box may hold nothing of the silhouette
            return 0.0, None, 0.0
        seen = own
        shares: dict[int | str, float] = {}
        for name, actor in nearer:
            place = actor.path(index)
            if actor.hides and overlap(place, box):
                cover = actor.seen(index).coverage(place, window)
                seen = seen * (1 - cover)
                shares[name] = shares.get(name, 0.0) + float((own * cover).sum()) / total
        visible = round(float(seen.sum()) / total, 9)
        most = max(shares, key=lambda name: shares[name], default=None)
        if most is None or shares[most] <= 0:
            return visible, None, 0.0
        return visible, most, min(round(shares[most], 9), 1.0)


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
    lorry_speed: float = parameter(
        0.5,
        "speed of lorries; above 1 they overtake the cars",
        minimum=0.2,
        maximum=2.0,
        unit="of the other vehicles'",
    )
    mixed: bool = parameter(False, "lorries drive among the cars, not in a lane of their own")
    view: str = parameter(
        "side",
        "gantry: in perspective from over the road, the last lane is the outer one; mast: from "
        "the middle of the road, the last lane is the inner one",
        choices=("side", "gantry", "mast"),
    )
    bridges: int = parameter(
        0,
        "bridges, each of which hides every vehicle once; in the view from the side",
        minimum=0,
        maximum=5,
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
