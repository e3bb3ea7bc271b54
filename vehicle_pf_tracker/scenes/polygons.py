# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cells of a grid inside a polygon, alike to the bit whatever the image library."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.scenes.compositing import PixelWindow


def cells_inside(
    outline: Array, rows: int, columns: int
) -> tuple[PixelWindow, npt.NDArray[np.bool_]]:
    """Find the cells of a grid whose centres lie inside a polygon, by the even-odd rule.

    Parameters
    ----------
    outline : array of shape (N, 2)
        Corners (x, y) in cells; cell `i` covers [i, i + 1).
    rows, columns : int
        Size of the grid.

    Returns
    -------
    window : PixelWindow
        The part of the grid around the polygon.
    inside : array of bool, shape of the window
    """
    low = outline.min(axis=0).tolist()
    high = outline.max(axis=0).tolist()
    window = PixelWindow.between(low, high, columns, rows)
    # Middles of cells: one on an edge belongs to one of two polygons that share it.
    x: Array = np.arange(window.left, window.right, dtype=np.float64) + 0.5
    y: Array = np.arange(window.top, window.bottom, dtype=np.float64) + 0.5
    crossings = _crossings(outline, y)
    inside = np.zeros((crossings.shape[1], x.size), dtype=np.bool_)
    # Crossings in pairs: between the first and the second is inside (even-odd rule).
    for enter, leave in zip(crossings[::2], crossings[1::2], strict=False):
        inside |= (x >= enter[:, np.newaxis]) & (x < leave[:, np.newaxis])
    return window, inside


def _crossings(outline: Array, y: Array) -> Array:
    """Find where the outline crosses each height `y`.

    Returns
    -------
    array of shape (at most N, len(y))
        The places (x) in rising order down each column; inf where there are no more.
    """
    x0, y0 = outline.T[..., np.newaxis]
    x1, y1 = np.roll(outline, -1, axis=0).T[..., np.newaxis]
    # Half-open in y: every row is crossed an even number of times, also through a corner.
    crosses = (y0 <= y) != (y1 <= y)
    # A level edge crosses no row; its rise only keeps the division defined.
    rise = np.where(y1 == y0, 1.0, y1 - y0)
    places = np.where(crosses, x0 + (y - y0) * (x1 - x0) / rise, np.inf)
    places.sort(axis=0)
    # Rows of nothing but inf are left out: a convex polygon has two crossings at most.
    return places[: int(crosses.sum(axis=0).max(initial=0))]
