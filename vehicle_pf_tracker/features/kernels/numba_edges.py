"""Edge points of many windows, each with a limit of its own, in numba."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.features.kernels.numba_cells import RECTANGLES, Rectangles
from vehicle_pf_tracker.features.kernels.numba_jit import compiled
from vehicle_pf_tracker.features.kernels.numba_windows import Counts
from vehicle_pf_tracker.features.sobel import Strengths

Gradients: TypeAlias = npt.NDArray[np.int16]
Limits: TypeAlias = npt.NDArray[np.float32]
Numbers: TypeAlias = npt.NDArray[np.int64]

_GRADIENTS = types.Array(types.int16, 2, "A", readonly=True)
_PLANE = types.float32[:, ::1]
_LIMITS = types.float32[::1]
_NUMBERS = types.UniTuple(types.int64[::1], 3)


@compiled(_PLANE(_GRADIENTS, _GRADIENTS))
def gradient_strengths(gx: Gradients, gy: Gradients) -> Strengths:
    """Squared magnitude, as `sobel.squared_strength` has it."""
    strengths = np.empty(gx.shape, np.float32)
    for y in range(gx.shape[0]):
        for x in range(gx.shape[1]):
            along, down = np.int32(gx[y, x]), np.int32(gy[y, x])
            strengths[y, x] = np.float32(along * along + down * down)
    return strengths


@compiled(_NUMBERS(_PLANE, types.float32))
def find_points(strengths: Strengths, limit: float) -> tuple[Numbers, Numbers, Numbers]:
    """List the pixels of at least this strength, row by row.

    Returns
    -------
    (H + 1,), (M,), (M,) arrays
        Number of the first point of each row, and of all points; their rows; their columns.
    """
    height, width = strengths.shape
    starts = np.zeros(height + 1, np.int64)
    rows, columns = np.empty(strengths.size, np.int64), np.empty(strengths.size, np.int64)
    count = 0
    for y in range(height):
        for x in range(width):
            if strengths[y, x] >= limit:
                rows[count], columns[count] = y, x
                count += 1
        starts[y + 1] = count
    return starts, rows[:count].copy(), columns[:count].copy()


@compiled(types.int64[::1](_NUMBERS, _LIMITS, RECTANGLES, _LIMITS, types.int32[:, ::1]))
def count_points(
    points: tuple[Numbers, Numbers, Numbers],
    strengths: Limits,
    rectangles: Rectangles,
    limits: Limits,
    counts: Counts,
) -> Numbers:
    """Count the points that are in a window and pass its limit.

    Parameters
    ----------
    points : (H + 1,), (M,), (M,) arrays
        Number of the first point of each row, and of all points; their columns; their cells.
    strengths : (M,) array
        Squared gradients of the points.
    rectangles, limits : (N, 4) array, (N,) array
        Left, top, right, bottom of each window; least squared gradient that counts in it.
    counts : (N, K + 1 or more) array
        Zeros, to which the points of each cell are added.

    Returns
    -------
    (N,) array
        Counts of all cells together.
    """
    starts, columns, cells = points
    totals = np.zeros(len(rectangles), np.int64)
    for i in range(len(rectangles)):
        left, top, right, bottom = rectangles[i]
        for point in range(starts[top], starts[bottom]):
            x = columns[point]
            passes = (x >= left) & (x < right) & (strengths[point] >= limits[i])
            counts[i, cells[point]] += passes
            totals[i] += passes
    return totals
