"""Ground textures from value noise: random levels on grids of several sizes, interpolated."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.scenes.compositing import Array, Colour, Image


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
    grid = rng.uniform(-1, 1, (int(down[-1]) + 2, int(right[-1]) + 2))
    row, column = down.astype(np.intp), right.astype(np.intp)
    fy, fx = (down - row)[:, np.newaxis], right - column
    rows: Array = grid[row] * (1 - fy) + grid[row + 1] * fy
    result: Array = rows[:, column] * (1 - fx) + rows[:, column + 1] * fx
    return result


def _tinted(base: Colour, shade: Array) -> Image:
    return (np.asarray(base) * (1 + shade[..., np.newaxis])).astype(np.float32)


def plain(shape: tuple[int, int], base: Colour, rng: np.random.Generator) -> Image:
    """Make a nearly even surface of colour `base`, shape (rows, columns, 3)."""
    shade = 0.03 * value_noise(shape, (60, 80), rng) + 0.02 * value_noise(shape, (9, 9), rng)
    return _tinted(base, shade)
