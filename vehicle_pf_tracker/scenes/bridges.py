"""A road bridge that crosses the whole image, away from the viewer, and its shadow."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Sprite
from vehicle_pf_tracker.scenes.paths import Still
from vehicle_pf_tracker.scenes.roads import PAINT
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.solids import SHADE
from vehicle_pf_tracker.scenes.textures import asphalt, concrete

PARAPET = 11
"""Width of the wall on each side of the deck, px."""
SHADOW_REACH = 30
"""How far the shadow falls to the left of the deck, px."""


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
    deck = Actor(_deck(round(width), height, rng), Still(box))
    shade = Box(left - SHADOW_REACH, 0.0, width, height)
    return Actor(_soft_band(round(width)), Still(shade), hides=False), deck


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
        colour[max(top, 0) : max(top + 18, 0), width // 2 - 1 : width // 2 + 1] = PAINT
    return Sprite(colour.clip(0, 255), np.ones((height, width)))


def _soft_band(width: int) -> Sprite:
    """Make a shadow with a penumbra of 4 px."""
    from_edge = np.minimum(np.arange(width) + 0.5, width - np.arange(width) - 0.5)
    opacity = 0.4 * np.clip(from_edge / 4, 0, 1)
    return Sprite(np.tile(SHADE, (1, width, 1)), opacity[np.newaxis])
