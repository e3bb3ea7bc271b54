# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Grounds: asphalt, grass, hedges and concrete, of random levels on grids of several sizes."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.scenes.compositing import Colour, Image, interpolate

MARKING_PAINT: Colour = (214, 214, 206)
"""Colour of markings."""


def value_noise(
    shape: tuple[int, int], cell: tuple[float, float], rng: np.random.Generator
) -> Array:
    """Smooth noise of about unit size.

    Parameters
    ----------
    shape : tuple of int
        Rows and columns.
    cell : tuple of float
        Height and width of the grid's cells in px; wide flat cells make streaks.
    rng : numpy.random.Generator
        Source of the random levels.

    Returns
    -------
    array of shape `shape`
        Uniform levels in [-1, 1] on the grid's corners, linear between them.
    """
    down = np.arange(shape[0]) / cell[0]
    right = np.arange(shape[1]) / cell[1]
    # A corner beyond the last cell in each direction, for the interpolation.
    grid = rng.uniform(-1, 1, (int(down[-1]) + 2, int(right[-1]) + 2))
    return interpolate(grid, down, right)


def _tinted(base: Colour, shade: Array) -> Image:
    # Shades are fractions of the base colour: dark materials vary less in levels, as real ones.
    return (np.asarray(base) * (1 + shade[..., np.newaxis])).astype(np.float32)


def plain(shape: tuple[int, int], base: Colour, rng: np.random.Generator) -> Image:
    """Make a nearly even surface of colour `base`, shape (rows, columns, 3)."""
    shade = 0.03 * value_noise(shape, (60, 80), rng) + 0.02 * value_noise(shape, (9, 9), rng)
    return _tinted(base, shade)


def asphalt(shape: tuple[int, int], rng: np.random.Generator) -> Image:
    """Make worn asphalt of a road along x: grain, patches, and streaks where tyres run."""
    grain = rng.uniform(-1, 1, shape)
    shade = (
        0.03 * grain
        + 0.04 * value_noise(shape, (2.5, 2.5), rng)
        + 0.05 * value_noise(shape, (30, 90), rng)
        + 0.04 * value_noise(shape, (3, 260), rng)
    )
    return _tinted((112, 112, 114), shade)


def grass(shape: tuple[int, int], rng: np.random.Generator) -> Image:
    """Make rough grass: tufts, and dry patches that are more yellow."""
    tufts = (
        0.10 * rng.uniform(-1, 1, shape)
        + 0.12 * value_noise(shape, (2, 3), rng)
        + 0.10 * value_noise(shape, (6, 11), rng)
        + 0.08 * value_noise(shape, (30, 70), rng)
    )
    dry = (0.5 + 0.5 * value_noise(shape, (18, 50), rng))[..., np.newaxis]
    hue = np.asarray((84.0, 108.0, 54.0)) * (1 - dry) + np.asarray((122.0, 122.0, 72.0)) * dry
    return (hue * (1 + tufts[..., np.newaxis])).astype(np.float32)


def foliage(shape: tuple[int, int], rng: np.random.Generator) -> Image:
    """Make the crowns of a hedge: lit tops, dark gaps."""
    crowns = value_noise(shape, (16, 22), rng) + 0.8 * value_noise(shape, (6, 8), rng)
    leaves = value_noise(shape, (2, 2), rng) + 0.6 * rng.uniform(-1, 1, shape)
    return _tinted((56, 80, 42), 0.22 * crowns + 0.16 * leaves)


def concrete(shape: tuple[int, int], rng: np.random.Generator) -> Image:
    """Make weathered concrete."""
    shade = (
        0.02 * rng.uniform(-1, 1, shape)
        + 0.03 * value_noise(shape, (3, 3), rng)
        + 0.05 * value_noise(shape, (40, 8), rng)
    )
    return _tinted((164, 161, 152), shade)
