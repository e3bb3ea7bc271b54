"""Roads of any place and number of lanes in open country or in town, with side roads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vehicle_pf_tracker.scenes.compositing import Image
from vehicle_pf_tracker.scenes.polygons import cells_inside
from vehicle_pf_tracker.scenes.roads import Lane, guard_rail, hedge, kerb, mark
from vehicle_pf_tracker.scenes.solids import ELEVATION
from vehicle_pf_tracker.scenes.textures import asphalt, concrete, grass

LANE_WIDTH = 3.25
"""Metres."""
SHOULDER = 8
"""From the kerb to the first lane, px."""


@dataclass(frozen=True, slots=True)
class Carriageway:
    """Lanes of one direction, side by side.

    Attributes
    ----------
    top : int
        First row of asphalt on the stage.
    lanes : int
        How many.
    scale : float
        Size, px per metre.
    rightward : bool
        Direction of travel.
    """

    top: int
    lanes: int
    scale: float
    rightward: bool

    @property
    def pitch(self) -> float:
        """Height of one lane in the image, px."""
        return LANE_WIDTH * self.scale * math.sin(ELEVATION)

    @property
    def rows(self) -> slice:
        """Rows of asphalt."""
        return slice(self.top, self.top + 2 * SHOULDER + round(self.lanes * self.pitch))

    def middle(self, number: int) -> float:
        """Row of the middle of lane `number`, counted from 0 at the far side."""
        return self.top + SHOULDER + (number + 0.5) * self.pitch

    def lane(self, number: int) -> Lane:
        """Lane `number`, counted from 0 at the far side, with wheels well inside it."""
        ground = self.middle(number) + 0.27 * self.pitch
        return Lane(ground, self.scale, self.rightward)


def countryside(
    shape: tuple[int, int], roads: Sequence[Carriageway], rng: np.random.Generator
) -> Image:
    """Draw roads through meadows between hedges, shape (*shape, 3); a rail divides two roads."""
    picture = grass(shape, rng)
    hedge(picture, 0, roads[0].top - 45, rng)
    if shape[0] - roads[-1].rows.stop > 80:
        hedge(picture, shape[0] - 30, shape[0], rng)
    _pave(picture, roads, rng)
    for far, near in pairwise(roads):
        guard_rail(picture, (far.rows.stop + near.top) // 2 - 6)
    return picture


def town(shape: tuple[int, int], roads: Sequence[Carriageway], rng: np.random.Generator) -> Image:
    """Draw roads between pavements of stone slabs, with a lawn behind, shape (*shape, 3)."""
    picture = concrete(shape, rng)
    picture[::14] *= np.float32(0.9)
    picture[:, ::20] *= np.float32(0.93)
    top, bottom = roads[0].top - 40, min(roads[-1].rows.stop + 40, shape[0])
    picture[:top] = grass((top, shape[1]), rng)
    picture[bottom:] = grass((shape[0] - bottom, shape[1]), rng)
    kerb(picture, slice(top + 2, bottom), rng)
    hedge(picture, 0, top - 60, rng)
    _pave(picture, roads, rng)
    return picture


def side_road(
    picture: Image,
    begin: tuple[float, float],
    end: tuple[float, float],
    width: float,
    rng: np.random.Generator,
) -> None:
    """Draw a road with a dashed middle line from `begin` to `end` (x, y), `width` px across."""
    (x0, y0), (x1, y1) = begin, end
    sides = (-width / 2 - 3, width / 2 + 3), (-width / 2, width / 2)
    for (left, right), light in zip(sides, (1.25, 1.0), strict=True):
        outline = np.array([(x0 + left, y0), (x0 + right, y0), (x1 + right, y1), (x1 + left, y1)])
        window, inside = cells_inside(outline, *picture.shape[:2])
        rows, columns = inside.shape
        ground = asphalt((columns, rows), rng).transpose(1, 0, 2) * np.float32(light)
        picture[window.slices][inside] = ground[inside]
    for row in range(max(round(y0), 0), min(round(y1), picture.shape[0])):
        if row % 24 < 13:
            column = round(x0 + (x1 - x0) * (row - y0) / (y1 - y0))
            picture[row, max(column - 1, 0) : max(column + 1, 0)] = (206, 206, 198)


def _pave(picture: Image, roads: Sequence[Carriageway], rng: np.random.Generator) -> None:
    for road in roads:
        rows = road.rows
        picture[rows] = asphalt((rows.stop - rows.start, picture.shape[1]), rng)
        kerb(picture, rows, rng)
        first = rows.start + SHOULDER
        dividers = tuple(round(first + number * road.pitch) for number in range(1, road.lanes))
        mark(picture, (first - 2, rows.stop - SHOULDER), dividers, rng)
