"""Vehicles in lanes: sprites at the lane's scale with their shadows, and convoys of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.features.box import Box
from vehicle_pf_tracker.scenes.compositing import Colour, Sprite
from vehicle_pf_tracker.scenes.paths import Attached, Path, Straight
from vehicle_pf_tracker.scenes.roads import Lane
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.solids import Face, draw, extent, mirrored, shadow
from vehicle_pf_tracker.scenes.vehicles import car, saloon, tinted, van

SHADOW_OPACITY = 0.5

PAINTS: tuple[Colour, ...] = (
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
class Vehicle:
    """A vehicle drawn for one lane, with its shadow.

    Attributes
    ----------
    body, shade : Sprite
        The vehicle, and its shadow.
    size : tuple of float
        Tight width and height of the body, px.
    shade_offset, shade_size : tuple of float
        The shadow's corner from the body's, and its size, px.
    """

    body: Sprite
    shade: Sprite
    size: tuple[float, float]
    shade_offset: tuple[float, float]
    shade_size: tuple[float, float]

    def box(self, left: float, lane: Lane) -> Box:
        """Box with its left edge at `left` and its wheels on the lane's ground."""
        return Box(left, lane.ground - self.size[1], *self.size)

    def on(self, path: Path) -> tuple[Actor, Actor]:
        """Send it along `path`; returns shadow and body, in the order to paint them."""
        follow = Attached(path, self.shade_offset, self.shade_size)
        return Actor(self.shade, follow, hides=False), Actor(self.body, path)


def vehicle(faces: Sequence[Face], lane: Lane) -> Vehicle:
    """Draw a solid as it looks in `lane`."""
    faces = faces if lane.rightward else mirrored(faces)
    cast = shadow(faces)
    body, shade = extent(faces), extent(cast)
    size = body.width * lane.scale, body.height * lane.scale
    shade_size = shade.width * lane.scale, shade.height * lane.scale
    return Vehicle(
        body=draw(faces, *size),
        shade=draw(cast, *shade_size, SHADOW_OPACITY),
        size=size,
        shade_offset=((shade.x - body.x) * lane.scale, (shade.y - body.y) * lane.scale),
        shade_size=shade_size,
    )


def any_car(lane: Lane, rng: np.random.Generator) -> Vehicle:
    """Draw a vehicle of a kind and colour left to chance."""
    kinds: tuple[Callable[[Colour], list[Face]], ...] = (car, saloon, saloon, van)
    paint = tinted(PAINTS[rng.integers(len(PAINTS))], rng.uniform(0.9, 1.08))
    return vehicle(kinds[rng.integers(len(kinds))](paint), lane)


def convoy(
    lane: Lane, speed: float, frame_count: int, width: int, rng: np.random.Generator
) -> list[Actor]:
    """Fill `lane` for the whole scene with vehicles that all drive at `speed` (px/frame, > 0).

    Gaps are left to chance. The lane runs across an image of `width` px.
    """
    models = [any_car(lane, rng) for _ in range(4)]
    velocity = speed if lane.rightward else -speed
    actors: list[Actor] = []
    ahead = rng.uniform(0, 200)
    while ahead < width + speed * frame_count:
        model = models[rng.integers(len(models))]
        # `ahead` counts backwards from the end of the lane that vehicles leave by.
        left = width - ahead - model.size[0] if lane.rightward else ahead
        actors += model.on(Straight(model.box(left, lane), (velocity, 0.0)))
        ahead += model.size[0] + rng.uniform(90, 420)
    return actors
