"""Edge points of many windows, each with a limit of its own, in numba."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.features.kernels.numba_cells import RECTANGLES, Rectangles, Table
from vehicle_pf_tracker.features.kernels.numba_jit import compiled
from vehicle_pf_tracker.features.kernels.numba_windows import Counts
from vehicle_pf_tracker.features.sobel import Strengths

Gradients: TypeAlias = npt.NDArray[np.int16]
Limits: TypeAlias = npt.NDArray[np.float32]
Index: TypeAlias = npt.NDArray[np.int32]
Numbers: TypeAlias = npt.NDArray[np.int64]

_GRADIENTS = types.Array(types.int16, 2, "A", readonly=True)
_PLANE = types.float32[:, ::1]
_LIMITS = types.float32[::1]
_NUMBERS = types.int64[::1]
_INDEX = types.int32[:, ::1]


@compiled(_PLANE(_GRADIENTS, _GRADIENTS))
def gradient_strengths(gx: Gradients, gy: Gradients) -> Strengths:
    """Squared magnitude, as `sobel.squared_strength` has it."""
    strengths = np.empty(gx.shape, np.float32)
    for y in range(gx.shape[0]):
        for x in range(gx.shape[1]):
            along, down = np.int32(gx[y, x]), np.int32(gy[y, x])
            strengths[y, x] = np.float32(along * along + down * down)
    return strengths


@compiled(types.Tuple((_INDEX, _NUMBERS, _NUMBERS))(_PLANE, types.float32))
def find_points(strengths: Strengths, limit: float) -> tuple[Index, Numbers, Numbers]:
    """List the pixels of at least this strength, row by row.

    Returns
    -------
    (H, W + 1), (M,), (M,) arrays
        Number of the first point that is not before a pixel; rows and columns of the points.
    """
    height, width = strengths.shape
    index = np.empty((height, width + 1), np.int32)
    rows, columns = np.empty(strengths.size, np.int64), np.empty(strengths.size, np.int64)
    count = 0
    for y in range(height):
        for x in range(width):
            index[y, x] = count
            rows[count], columns[count] = y, x
            count += strengths[y, x] >= limit
        index[y, width] = count
    return index, rows[:count].copy(), columns[:count].copy()


@compiled(_NUMBERS(_INDEX, types.uint16[::1], _LIMITS, RECTANGLES, _LIMITS, types.int32[:, ::1]))
def count_points(
    index: Index,
    cells: Table,
    strengths: Limits,
    rectangles: Rectangles,
    limits: Limits,
    counts: Counts,
) -> Numbers:
    """Count the points that are in a window and pass its limit.

    Parameters
    ----------
    index : (H, W + 1) array
        As from `find_points`.
    cells, strengths : (M,) arrays
        Cell and squared gradient of each point.
    rectangles, limits : (N, 4) array, (N,) array
        Left, top, right, bottom of each window; least squared gradient that counts in it.
    counts : (N, K + 1 or more) array
        Filled with the points of each cell.

    Returns
    -------
    (N,) array
        Counts of all cells together.
    """
    totals = np.zeros(len(rectangles), np.int64)
    for i in range(len(rectangles)):
        left, top, right, bottom = rectangles[i]
        limit, own = limits[i], counts[i]
        own[:] = 0
        for y in range(top, bottom):
            # An unsigned number needs no look at whether it counts from the end.
            for point in range(np.uint32(index[y, left]), np.uint32(index[y, right])):
                own[cells[point]] += np.int32(strengths[point] >= limit)
        for k in range(len(own)):
            totals[i] += own[k]
    return totals
