# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Picture of the ground with a road on it, as a camera sees it in perspective.

Coordinates in metres on the road: x to the right, y ahead.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from laboratory.scenes.perspective import RoadCamera
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.scenes.compositing import Image
from vehicle_pf_tracker.scenes.grounds import asphalt, grass

_MARK = (214, 214, 206)
"""Paint of lines, as on the roads that are seen from the side."""
_SKY = (186, 200, 214)
"""Hazy sky above the horizon."""
_CELL = 0.06
"""Size of a texture's cell on the ground, m: what a pixel covers 60 m away."""
_TILE = 512
"""Cells of a texture before it is mirrored: 31 m, so that no pattern is seen to repeat."""
_DASH, _PERIOD = 4, 12
"""Length of a dash, and from one to the next, m: common on country roads."""
_DASHED, _SOLID = 0.07, 0.09
"""Half widths of a line, m: 14 and 18 cm."""


@dataclass(frozen=True, slots=True)
class RoadMarks:
    """Asphalt and lines of a road along y, by their x in m.

    Attributes
    ----------
    tar : tuple of (float, float)
        Left and right side of each strip of asphalt.
    dashed, solid : tuple of float
        Middles of the lines.
    """

    tar: tuple[tuple[float, float], ...]
    dashed: tuple[float, ...]
    solid: tuple[float, ...]


def ground_picture(
    camera: RoadCamera, size: tuple[int, int], marks: RoadMarks, rng: np.random.Generator
) -> Image:
    """Draw the ground (width, height in px) as the mean of two by two points in each pixel."""
    tar = asphalt((_TILE, _TILE), rng)
    green = grass((_TILE, _TILE), rng)
    width, height = size
    plane = camera.plane
    total = np.zeros((height, width, 3))
    # Four points of each pixel: lines are thinner than a pixel far away, and one point would miss
    # them in some rows.
    for down in (0.25, 0.75):
        for right in (0.25, 0.75):
            rows, columns = np.mgrid[0:height, 0:width] + 0.0
            pixels = np.stack([columns + right, rows + down], axis=-1)
            ideal = plane.ideal(pixels)
            ground = plane.homography.to_road(ideal)
            # Rays above the horizon meet the road behind the camera: they are sky.
            below = (plane.homography.nearness(ideal) > 1e-3)[..., np.newaxis]
            # Any finite point: its colour is not used.
            points = np.where(below, ground, 0.0)
            total += np.where(below, _colours(points, marks, tar, green), _SKY)
    return (total / 4).astype(np.float32)


def _colours(points: Array, marks: RoadMarks, tar: Image, green: Image) -> Array:
    """Colour of road points (…, 2)."""
    x, y = np.moveaxis(points, -1, 0)
    on_tar = np.zeros(x.shape, dtype=np.bool_)
    for left, right in marks.tar:
        on_tar |= (x > left) & (x < right)
    colour = np.where(on_tar[..., np.newaxis], _sampled(tar, x, y), _sampled(green, x, y))
    # Counted from y = 0, where a dash begins.
    dashed = _near(x, marks.dashed, _DASHED) & (y % _PERIOD < _DASH)
    line = dashed | _near(x, marks.solid, _SOLID)
    return np.where(line[..., np.newaxis], _MARK, colour)


def _near(x: Array, lines: tuple[float, ...], reach: float) -> npt.NDArray[np.bool_]:
    near = np.zeros(x.shape, dtype=np.bool_)
    for line in lines:
        near |= np.abs(x - line) < reach
    return near


def _sampled(tile: Image, x: Array, y: Array) -> Image:
    """Look a texture up at road points; it goes on mirrored."""
    columns, rows = (
        # Mirrored at the tile's ends, where a plain repetition would draw a line across the road.
        np.abs((np.floor(place / _CELL).astype(np.intp) % (2 * _TILE)) - _TILE) % _TILE
        for place in (x, y)
    )
    sampled: Image = tile[rows, columns]
    return sampled
