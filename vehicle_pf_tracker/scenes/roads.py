# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Roads with their lanes: a dual carriageway, or any number of lanes in country or town."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vehicle_pf_tracker.scenes.compositing import Colour, Image
from vehicle_pf_tracker.scenes.grounds import (
    MARKING_PAINT,
    asphalt,
    concrete,
    foliage,
    grass,
    value_noise,
)
from vehicle_pf_tracker.scenes.lane_traffic import Lane
from vehicle_pf_tracker.scenes.solids import VIEW_ELEVATION

LANE_WIDTH = 3.25
"""Width of a lane, m: between those of a city (3.0) and a motorway (3.75)."""
SHOULDER = 8
"""Distance from the kerb to the first lane, px: about a metre, as foreshortened as the lanes."""
STEEL: Colour = (176, 180, 182)
"""Galvanised guard rails in the sun."""


_FAR_ROAD = slice(82, 194)
"""Rows of asphalt of the far carriageway on the highway, px: three lanes at its scale."""
_NEAR_ROAD = slice(224, 352)
"""Rows of asphalt of the near carriageway, whose scale is larger, px."""
_FAR_EDGES = (102, 186)
"""Rows of the far edge lines, px; the wheels of `FAR_LANES` stand between the markings."""
_FAR_DIVIDERS = (130, 156)
"""Rows of the dashed lines between the far lanes, px."""
_NEAR_EDGES = (232, 326)
"""Rows of the near edge lines, px."""
_NEAR_DIVIDERS = (263, 294)
"""Rows of the dashed lines between the near lanes, px."""


def dual_carriageway(width: int, height: int, rng: np.random.Generator) -> Image:
    """Draw the empty road of `FAR_LANES` and `NEAR_LANES`, shape (height, width, 3)."""
    picture = grass((height, width), rng)
    hedge(picture, 0, 50, rng)
    hedge(picture, height - 42, height, rng)
    for road in (_FAR_ROAD, _NEAR_ROAD):
        picture[road] = asphalt((road.stop - road.start, width), rng)
        kerb(picture, road, rng)
    mark(picture, _FAR_EDGES, _FAR_DIVIDERS, rng)
    mark(picture, _NEAR_EDGES, _NEAR_DIVIDERS, rng)
    guard_rail(picture, 204)
    return picture


def hedge(picture: Image, top: int, bottom: int, rng: np.random.Generator) -> None:
    """Grow a hedge with ragged edges and its shadow on the side of the viewer."""
    height, width = picture.shape[:2]
    # Large and small raggedness: crowns, and twigs on them.
    ragged = 5 * value_noise((1, width), (1, 14), rng) + 2 * value_noise((1, width), (1, 4), rng)
    # Displaced rows, compared with straight limits, have ragged edges.
    rows = np.arange(height)[:, np.newaxis] + ragged
    shaded = (rows >= bottom) & (rows < bottom + 9)
    crowns = (rows >= top) & (rows < bottom)
    picture[shaded] *= np.float32(0.66)
    picture[crowns] = foliage((height, width), rng)[crowns]


def kerb(picture: Image, road: slice, rng: np.random.Generator) -> None:
    """Lay kerbstones along both sides of the rows `road`."""
    for top in (road.start - 2, road.stop):
        picture[top : top + 2] = 0.8 * concrete((2, picture.shape[1]), rng)


def mark(
    picture: Image, edges: tuple[int, int], dividers: tuple[int, ...], rng: np.random.Generator
) -> None:
    """Paint solid edge lines and the dashed lines between lanes."""
    width = picture.shape[1]
    for top in edges:
        _stripe(picture, top, 0, width, rng)
    # 38 of 112 px: dashes of 3 m every 9 m at the highway's 12.4 px/m.
    for top in dividers:
        for left in range(int(rng.integers(-60, 0)), width, 112):
            _stripe(picture, top, max(left, 0), min(left + 38, width), rng)


def _stripe(picture: Image, top: int, left: int, right: int, rng: np.random.Generator) -> None:
    if right <= left:
        return
    # Worn paint lets the asphalt through, pixel by pixel, as tyres have rubbed it off.
    worn = rng.uniform(0.55, 0.9, (2, right - left, 1)).astype(np.float32)
    region = picture[top : top + 2, left:right]
    region += worn * (np.asarray(MARKING_PAINT, np.float32) - region)


def guard_rail(picture: Image, top: int) -> None:
    """Draw posts, a rail with its lit upper edge, and its shadow on the ground."""
    picture[top + 8 : top + 12] *= np.float32(0.72)
    for left in range(9, picture.shape[1], 50):
        picture[top : top + 10, left : left + 2] = 0.6 * np.asarray(STEEL)
    for row, light in enumerate((1.1, 1.0, 0.8, 0.95, 0.75)):
        picture[top + row] = light * np.asarray(STEEL)


@dataclass(frozen=True, slots=True)
class Carriageway:
    """Lanes of one direction, side by side.

    Attributes
    ----------
    top, lanes : int
        First row of asphalt on the stage, and number of lanes.
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
        return LANE_WIDTH * self.scale * math.sin(VIEW_ELEVATION)

    @property
    def rows(self) -> slice:
        """Rows of asphalt."""
        return slice(self.top, self.top + 2 * SHOULDER + round(self.lanes * self.pitch))

    def middle(self, number: int) -> float:
        """Row of the middle of lane `number`, counted from 0 at the far side."""
        return self.top + SHOULDER + (number + 0.5) * self.pitch

    def lane(self, number: int) -> Lane:
        """Lane `number`, counted from 0 at the far side, with wheels well inside it."""
        # A quarter of the lane below its middle: the near wheels, not the vehicle's middle.
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
    # Half of the rail's 12 rows above the middle between the roads.
    for far, near in pairwise(roads):
        guard_rail(picture, (far.rows.stop + near.top) // 2 - 6)
    return picture


def town(shape: tuple[int, int], roads: Sequence[Carriageway], rng: np.random.Generator) -> Image:
    """Draw roads between pavements of stone slabs, with a lawn behind, shape (*shape, 3)."""
    picture = concrete(shape, rng)
    # Joints between slabs.
    picture[::14] *= np.float32(0.9)
    picture[:, ::20] *= np.float32(0.93)
    top = roads[0].top - 40
    bottom = min(roads[-1].rows.stop + 40, shape[0])
    picture[:top] = grass((top, shape[1]), rng)
    picture[bottom:] = grass((shape[0] - bottom, shape[1]), rng)
    kerb(picture, slice(top + 2, bottom), rng)
    hedge(picture, 0, top - 60, rng)
    _pave(picture, roads, rng)
    return picture


def _pave(picture: Image, roads: Sequence[Carriageway], rng: np.random.Generator) -> None:
    for road in roads:
        rows = road.rows
        picture[rows] = asphalt((rows.stop - rows.start, picture.shape[1]), rng)
        kerb(picture, rows, rng)
        first = rows.start + SHOULDER
        dividers = tuple(round(first + number * road.pitch) for number in range(1, road.lanes))
        # The edge lines outside of the lanes: they are 2 px high and painted downwards.
        mark(picture, (first - 2, rows.stop - SHOULDER), dividers, rng)
