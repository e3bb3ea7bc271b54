"""A dual carriageway seen from beside it: ground, markings, guard rail; and its lanes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.scenes.compositing import Colour, Image
from vehicle_pf_tracker.scenes.textures import asphalt, concrete, foliage, grass, value_noise

PAINT: Colour = (214, 214, 206)
STEEL: Colour = (176, 180, 182)


@dataclass(frozen=True, slots=True)
class Lane:
    """Where and how big vehicles are in one lane.

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

_FAR_ROAD, _NEAR_ROAD = slice(82, 194), slice(224, 352)
_FAR_EDGES, _FAR_DIVIDERS = (102, 186), (130, 156)
_NEAR_EDGES, _NEAR_DIVIDERS = (232, 326), (263, 294)


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
    ragged = 5 * value_noise((1, width), (1, 14), rng) + 2 * value_noise((1, width), (1, 4), rng)
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
    for top in dividers:
        for left in range(int(rng.integers(-60, 0)), width, 112):
            _stripe(picture, top, max(left, 0), min(left + 38, width), rng)


def _stripe(picture: Image, top: int, left: int, right: int, rng: np.random.Generator) -> None:
    if right <= left:
        return
    worn = rng.uniform(0.55, 0.9, (2, right - left, 1)).astype(np.float32)
    region = picture[top : top + 2, left:right]
    region += worn * (np.asarray(PAINT, np.float32) - region)


def guard_rail(picture: Image, top: int) -> None:
    """Draw posts, a rail with its lit upper edge, and its shadow on the ground."""
    picture[top + 8 : top + 12] *= np.float32(0.72)
    for left in range(9, picture.shape[1], 50):
        picture[top : top + 10, left : left + 2] = 0.6 * np.asarray(STEEL)
    for row, light in enumerate((1.1, 1.0, 0.8, 0.95, 0.75)):
        picture[top + row] = light * np.asarray(STEEL)
