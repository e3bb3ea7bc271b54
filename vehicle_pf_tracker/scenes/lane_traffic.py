# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles in lanes: sprites at the scale of a lane with their shadows, and convoys of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Colour, Sprite
from vehicle_pf_tracker.scenes.courses import moving
from vehicle_pf_tracker.scenes.scene import Actor, Path
from vehicle_pf_tracker.scenes.solids import SHADOW_OPACITY, Face, draw, extent, mirrored, shadow
from vehicle_pf_tracker.scenes.vehicle_parts import tinted
from vehicle_pf_tracker.scenes.vehicles import car, saloon, van

CAR_PAINTS: tuple[Colour, ...] = (
    (222, 222, 220),
    (168, 172, 176),
    (44, 46, 50),
    (96, 100, 104),
    (158, 34, 36),
    (40, 74, 58),
    (186, 172, 140),
    (206, 208, 212),
)
"""Common colours of cars; none is near the target's."""


@dataclass(frozen=True, slots=True)
class Lane:
    """A lane: position and scale of its vehicles.

    Attributes
    ----------
    ground : float
        Height in the image (px) at which the near wheels stand.
    scale : float
        Size, px per metre.
    rightward : bool
        Direction of travel.
    """

    ground: float
    scale: float
    rightward: bool


FAR_LANES = (Lane(123, 12.4, True), Lane(151, 12.4, True), Lane(176, 12.4, True))
"""Slow, middle and fast lane of the far carriageway; traffic keeps to the left."""
NEAR_LANES = (Lane(256, 13.8, False), Lane(286, 13.8, False), Lane(316, 13.8, False))
"""Fast, middle and slow lane of the near carriageway."""


class LaneVehicle:
    """The appearance of a vehicle in one lane, with its shadow; drawn when first seen.

    Parameters
    ----------
    faces : sequence of Face
        The solid, heading to the right.
    lane : Lane
        The lane it drives in.
    """

    def __init__(self, faces: Sequence[Face], lane: Lane) -> None:
        self._faces = faces if lane.rightward else mirrored(faces)
        self._cast = shadow(self._faces)
        body = extent(self._faces)
        shade = extent(self._cast)
        scale = lane.scale
        self.size = body.width * scale, body.height * scale
        # The shadow is a picture of its own, with a tight box of its own; it moves with the body.
        self._shade_size = shade.width * scale, shade.height * scale
        self._shade_offset = (shade.x - body.x) * scale, (shade.y - body.y) * scale

    def box(self, left: float, lane: Lane) -> Box:
        """Box with its left edge at `left` and its wheels on the lane's ground."""
        return Box(left, lane.ground - self.size[1], *self.size)

    def on(self, path: Path) -> tuple[Actor, Actor]:
        """Send it along `path`; returns shadow and body, in the order to paint them."""
        right, down = self._shade_offset
        size = self._shade_size

        def follow(frame: float) -> Box:
            body = path(frame)
            return Box(body.x + right, body.y + down, *size)

        return (
            # Sprites by name, not by value: those of vehicles that are never seen are never drawn.
            Actor(lambda _: self._shade, follow, hides=False),
            Actor(lambda _: self._body, path),
        )

    @cached_property
    def _body(self) -> Sprite:
        return draw(self._faces, *self.size)

    @cached_property
    def _shade(self) -> Sprite:
        return draw(self._cast, *self._shade_size, SHADOW_OPACITY)


Kinds: TypeAlias = tuple[Callable[[Colour], list[Face]], ...]
"""Kinds of vehicles to choose from; each makes the solid of one colour."""


def any_car(
    lane: Lane, rng: np.random.Generator, kinds: Kinds = (car, saloon, saloon, van)
) -> LaneVehicle:
    """Draw a vehicle of a kind and colour left to chance."""
    paint = tinted(CAR_PAINTS[rng.integers(len(CAR_PAINTS))], rng.uniform(0.9, 1.08))
    return LaneVehicle(kinds[rng.integers(len(kinds))](paint), lane)


class Stage(NamedTuple):
    """Part of the world that a scene shows.

    Attributes
    ----------
    frame_count : int
        Frames that it is shown for.
    width : int
        Width, px.
    """

    frame_count: int
    width: int


def convoy(
    lane: Lane,
    speed: float,
    stage: Stage,
    rng: np.random.Generator,
    gaps: tuple[float, float] = (90, 420),
    kinds: Kinds = (car, saloon, saloon, van),
) -> list[Actor]:
    """Fill `lane` for the whole scene with vehicles that all drive at `speed` (px/frame, > 0).

    Gaps are left to chance between two limits (px). The lane runs across the stage.
    """
    # Four models a lane: sprites are drawn once and used for many vehicles.
    models = [any_car(lane, rng, kinds) for _ in range(4)]
    velocity = speed if lane.rightward else -speed
    actors: list[Actor] = []
    ahead = rng.uniform(0, 200)
    # As much traffic as passes: what the stage holds, and what comes in over the whole scene.
    while ahead < stage.width + speed * stage.frame_count:
        model = models[rng.integers(len(models))]
        # `ahead` counts backwards from the end of the lane that vehicles leave by.
        left = stage.width - ahead - model.size[0] if lane.rightward else ahead
        actors += model.on(moving(model.box(left, lane), velocity))
        ahead += model.size[0] + rng.uniform(*gaps)
    return actors
