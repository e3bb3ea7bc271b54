# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Obstacles in front of the road: pillars, posts, trees and bridges."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Colour, Sprite
from vehicle_pf_tracker.scenes.courses import standing
from vehicle_pf_tracker.scenes.grounds import MARKING_PAINT, asphalt, concrete, foliage, value_noise
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.solids import SHADOW_TINT

STEEL: Colour = (128, 132, 134)
"""Lamp posts and poles, weathered."""
BARK: Colour = (74, 62, 50)
"""Trunks of trees."""
PARAPET = 11
"""Width of the wall on each side of the deck, px: a little less than a metre."""
SHADOW_REACH = 30
"""Reach of the shadow to the left of the deck, px: the sun's, of a deck 6 m up at 12 px/m."""


def opaque(colour: Array, box: Box) -> Actor:
    """Make an opaque thing that stands in `box` for ever."""
    return Actor(Sprite(colour.clip(0, 255), np.ones(colour.shape[:2])), standing(box))


def pillar(middle: float, width: float, height: int, rng: np.random.Generator) -> list[Actor]:
    """Make a dark concrete pillar as high as the stage, `height` px."""
    columns = max(round(width), 1)
    # Brightest left of the middle, darker to both sides: a flat stripe would look like a gap.
    light = 0.34 - 0.12 * np.abs(np.linspace(-0.6, 1, columns))
    colour = concrete((height, columns), rng) * light[np.newaxis, :, np.newaxis]
    return [opaque(colour, Box(middle - width / 2, 0.0, width, height))]


def post(middle: float, width: float, top: float, bottom: float) -> list[Actor]:
    """Make a lamp post or a pole, lit from the right."""
    # Four columns per pixel: the gradient stays even at positions between pixels.
    light = np.linspace(0.55, 1.05, max(round(4 * width), 4))
    colour = np.asarray(STEEL) * light[np.newaxis, :, np.newaxis]
    return [opaque(colour, Box(middle - width / 2, top, width, bottom - top))]


def tree(
    middle: float,
    crown: tuple[float, float, float],
    foot: float,
    density: float,
    rng: np.random.Generator,
) -> list[Actor]:
    """Make a tree: a trunk and a ragged crown.

    Parameters
    ----------
    middle : float
        Middle of the tree on the stage, px.
    crown : tuple of float
        Width, top and bottom of the crown, px.
    foot : float
        Row of the ground it stands on, px.
    density : float
        Density of the crown: at 1 it has no gaps; with less, leaves remain longest in its middle.
    rng : numpy.random.Generator
        Source of its shape.
    """
    width, top, bottom = crown
    # Two cells per pixel and axis: leaves are finer than pixels, and cover them partly.
    rows = round(2 * (bottom - top))
    columns = round(2 * width)
    y, x = np.linspace(-1, 1, rows)[:, np.newaxis], np.linspace(-1, 1, columns)
    # 1 in the middle, 0 on the ellipse in the box; noise makes the outline ragged.
    rim = 1 - np.hypot(x, y) + 0.22 * value_noise((rows, columns), (14, 14), rng)
    gaps = value_noise((rows, columns), (7, 8), rng) + 0.5 * value_noise(
        (rows, columns), (3, 3), rng
    )
    # `gaps` is within 1.5 of 0: at density 1 (2.4 - 0.9 = 1.5) all leaves stay. Deep inside the rim
    # the limit rises, as more branches lie behind each other there.
    leaves = (rim > 0.1) & (gaps < 2.4 * density - 0.9 + np.clip(rim - 0.35, 0, 1))
    colour = foliage((rows, columns), rng) * (1.05 - 0.25 * y)[..., np.newaxis]
    # A trunk takes the place of a post; 3 px at least, so that a small tree still has one.
    trunk = post(middle, max(0.07 * width, 3.0), (top + bottom) / 2, foot)
    bark = Sprite.plain(BARK)
    return [
        *(Actor(bark, part.path) for part in trunk),
        Actor(
            Sprite(colour.clip(0, 255), leaves.astype(float)),
            standing(Box(middle - width / 2, top, width, bottom - top)),
        ),
    ]


def bridge(left: float, width: float, height: int, rng: np.random.Generator) -> tuple[Actor, Actor]:
    """Make the shadow and the bridge, in the order to paint them.

    Parameters
    ----------
    left, width : float
        Left edge and width of the bridge, px.
    height : int
        Image height, px.
    rng : numpy.random.Generator
        Source of the textures.
    """
    box = Box(left, 0.0, width, height)
    deck = Actor(_deck(round(width), height, rng), standing(box))
    shade = Box(left - SHADOW_REACH, 0.0, width, height)
    return Actor(_soft_band(round(width)), standing(shade), hides=False), deck


def _deck(width: int, height: int, rng: np.random.Generator) -> Sprite:
    # The deck's texture runs along the bridge, so it is drawn lying and turned.
    colour = asphalt((width, height), rng).transpose(1, 0, 2) * np.float32(0.86)
    walls = concrete((height, width), rng)
    for side in (slice(0, PARAPET), slice(width - PARAPET, width)):
        colour[:, side] = walls[:, side]
        colour[:, side.start : side.start + 2] *= np.float32(1.12)
        colour[:, side.stop - 2 : side.stop] *= np.float32(0.6)
    colour[:, width - PARAPET - 8 : width - PARAPET] *= np.float32(0.7)
    for top in range(int(rng.integers(-20, 0)), height, 44):
        colour[max(top, 0) : max(top + 18, 0), width // 2 - 1 : width // 2 + 1] = MARKING_PAINT
    return Sprite(colour.clip(0, 255), np.ones((height, width)))


def _soft_band(width: int) -> Sprite:
    """Make a shadow with a penumbra of 4 px."""
    from_edge = np.minimum(np.arange(width) + 0.5, width - np.arange(width) - 0.5)
    opacity = 0.4 * np.clip(from_edge / 4, 0, 1)
    return Sprite(np.tile(SHADOW_TINT, (1, width, 1)), opacity[np.newaxis])
