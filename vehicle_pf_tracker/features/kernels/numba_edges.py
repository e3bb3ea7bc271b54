"""Edge points of many windows, each with a limit of its own, in numba."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.features.kernels.numba_cells import RECTANGLES, TABLE, Rectangles, Table
from vehicle_pf_tracker.features.kernels.numba_jit import compiled, inlined
from vehicle_pf_tracker.features.kernels.numba_windows import Counts
from vehicle_pf_tracker.features.sobel import DIRECTION_BINS, Strengths

Gradients: TypeAlias = npt.NDArray[np.int16]
Limits: TypeAlias = npt.NDArray[np.float32]
Images: TypeAlias = tuple[Gradients, Gradients, Strengths]
Tangents: TypeAlias = npt.NDArray[np.float64]
Index: TypeAlias = npt.NDArray[np.int32]
Numbers: TypeAlias = npt.NDArray[np.int64]

_GRADIENTS = types.int16[:, ::1]
_TANGENTS = types.Array(types.float64, 1, "C", readonly=True)
_PLANE = types.float32[:, ::1]
_IMAGES = types.Tuple((_GRADIENTS, _GRADIENTS, _PLANE))
_LIMITS = types.float32[::1]
_NUMBERS = types.int64[::1]
_INDEX = types.int32[:, ::1]

TANGENTS: Tangents = np.tan(np.arange(1, DIRECTION_BINS // 4) * (2 * np.pi / DIRECTION_BINS))
"""Tangents of the directions between the bins of a quarter turn."""
TANGENTS.flags.writeable = False


@compiled(_PLANE(_GRADIENTS, _GRADIENTS))
def gradient_strengths(gx: Gradients, gy: Gradients) -> Strengths:
    """Squared magnitude, as `sobel.squared_strength` has it."""
    strengths = np.empty(gx.shape, np.float32)
    for y in range(gx.shape[0]):
        for x in range(gx.shape[1]):
            along, down = np.int32(gx[y, x]), np.int32(gy[y, x])
            strengths[y, x] = np.float32(along * along + down * down)
    return strengths


@inlined
def _direction_bin(gx: int, gy: int, tangents: Tangents, signed: bool) -> int:
    """Bin 0 to 63, as `sobel.direction_bins` has it; whole numbers are never near a tangent."""
    if not signed and (gx < 0 or (gx == 0 and gy < 0)):
        gx, gy = -gx, -gy
    if gx > 0 and gy >= 0:
        first, along, across = 32, gx, gy
    elif gy > 0:
        first, along, across = 48, gy, -gx
    elif gx < 0:
        first, along, across = 0, -gx, -gy
    else:
        first, along, across = 16, -gy, gx
    for tangent in tangents:
        first += across >= along * tangent
    return first


@compiled(
    types.Tuple((_INDEX, types.uint16[::1], _LIMITS))(
        types.Tuple((_GRADIENTS, _GRADIENTS, _PLANE)),
        types.float32,
        TABLE,
        _TANGENTS,
        types.boolean,
    )
)
def find_points(
    images: Images,
    limit: float,
    table: Table,
    tangents: Tangents,
    signed: bool,
) -> tuple[Index, Table, Limits]:
    """List the pixels of at least this strength, row by row.

    Parameters
    ----------
    images : three (H, W) arrays
        Gradient along x and y, and its squared magnitude.
    limit : float
        Least squared magnitude.
    table : (64,) array
        Cell of each direction.
    tangents : (15,) array
        As `TANGENTS`.
    signed : bool
        As in `sobel.direction_bins`.

    Returns
    -------
    (H, W + 1), (M,), (M,) arrays
        Number of the first point that is not before a pixel; cells and strengths of the points.
    """
    gx, gy, strengths = images
    height, width = strengths.shape
    index = np.empty((height, width + 1), np.int32)
    cells = np.empty(strengths.size, np.uint16)
    passed = np.empty(strengths.size, np.float32)
    count = 0
    for y in range(height):
        for x in range(width):
            index[y, x] = count
            if strengths[y, x] >= limit:
                bin_number = _direction_bin(
                    np.int64(gx[y, x]), np.int64(gy[y, x]), tangents, signed
                )
                cells[count], passed[count] = table[bin_number], strengths[y, x]
                count += 1
        index[y, width] = count
    return index, cells[:count].copy(), passed[:count].copy()


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
