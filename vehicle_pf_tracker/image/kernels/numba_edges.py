# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edge points of many windows, each with a limit of its own, in numba."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.image.gradients import DIRECTION_BINS
from vehicle_pf_tracker.image.kernels.numba_jit import (
    RECTANGLES,
    TABLE,
    Rectangles,
    Table,
    compiled,
    inlined,
)
from vehicle_pf_tracker.image.kernels.numba_windows import PAIR, Counts

Gradients: TypeAlias = npt.NDArray[np.int16]
Strengths: TypeAlias = npt.NDArray[np.int32]
Points: TypeAlias = tuple[Strengths, Table, Strengths]
Tangents: TypeAlias = npt.NDArray[np.float64]
Numbers: TypeAlias = npt.NDArray[np.int64]

_NUMBERS = types.int64[::1]
_TANGENTS = types.Array(types.float64, 1, "C", readonly=True)

_NEVER = 1 << 31
"""Limit that nothing passes: squared magnitudes are at most 2 * 1020²."""

TANGENTS: Tangents = np.tan(np.arange(1, DIRECTION_BINS // 4) * (2 * np.pi / DIRECTION_BINS))
"""Tangents of the directions between the bins of a quarter turn."""
TANGENTS.flags.writeable = False


@inlined
def direction_bin(gx: int, gy: int, tangents: Tangents, signed: bool) -> int:
    """Bin 0 to 63, as `gradients.direction_bins` has it; integers are never near a tangent."""
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


@inlined
def _list_points(
    gradients: tuple[Gradients, Gradients],
    strengths: Strengths,
    limit: int,
    directions: tuple[Table, Tangents, bool],
) -> Points:
    """List the pixels that pass a limit, row by row.

    Returns
    -------
    (H, W + 1), (M,), (M,) arrays
        Number of the first point that is not before a pixel; cells and strengths of the points.
    """
    (gx, gy), (table, tangents, signed) = gradients, directions
    height, width = strengths.shape
    index = np.empty((height, width + 1), np.int32)
    cells, passed = np.empty(strengths.size, np.uint16), np.empty(strengths.size, np.int32)
    found = np.empty(width, np.int32)
    count = 0
    for y in range(height):
        here = 0
        for x in range(width):
            index[y, x] = count + here
            found[here] = x
            here += strengths[y, x] >= limit
        index[y, width] = count + here
        for i in range(here):
            x = found[i]
            number = direction_bin(np.int64(gx[y, x]), np.int64(gy[y, x]), tangents, signed)
            cells[count + i], passed[count + i] = table[number], strengths[y, x]
        count += here
    return index, cells, passed


@inlined
def _count_window(
    points: Points, limit: int, window: tuple[int, int, int, int], counts: Strengths
) -> int:
    """Fill the counts of one window's points that pass its limit, and return their number."""
    index, cells, strengths = points
    left, top, right, bottom = window
    counts[:] = 0
    total = 0
    for y in range(top, bottom):
        # An unsigned index needs no test for counting from the end.
        for point in range(np.uint32(index[y, left]), np.uint32(index[y, right])):
            passes = strengths[point] >= limit
            counts[cells[point]] += np.int32(passes)
            total += passes
    return total


@inlined
def _limits_of(
    strengths: Strengths, middles: Rectangles, half: tuple[int, int], rule: tuple[float, float]
) -> Numbers:
    """Least squared magnitude that counts in each window; see `GradientDirections.counts`."""
    (share, least), (across, up) = rule, half
    height, width = strengths.shape
    limits = np.full(len(middles), _NEVER, np.int64)
    for i in range(len(middles)):
        x, y = middles[i]
        left, right = np.uint32(max(x - across, 0)), np.uint32(min(x + across + 1, width))
        peak = np.int32(0)
        for row in range(max(y - up, 0), min(y + up + 1, height)):
            for column in range(left, right):
                peak = max(peak, strengths[row, column])
        if peak > 0:
            limits[i] = np.int64(math.ceil(max(share * np.float32(peak), least)))
    return limits


@compiled(
    _NUMBERS(
        types.UniTuple(types.int16[:, ::1], 2),
        RECTANGLES,
        PAIR,
        types.UniTuple(types.float32, 2),
        types.Tuple((TABLE, _TANGENTS, types.boolean)),
        types.int32[:, ::1],
    )
)
def count_edges(
    gradients: tuple[Gradients, Gradients],
    middles: Rectangles,
    half: tuple[int, int],
    rule: tuple[float, float],
    directions: tuple[Table, Tangents, bool],
    counts: Counts,
) -> Numbers:
    """Count the edge points of windows by the cells of their directions.

    Parameters
    ----------
    gradients : (H, W) array, (H, W) array
        Gradient along x and y.
    middles : (N, 2) array
        x, y of each window's middle pixel; what is beyond the array is not counted.
    half : (int, int)
        Half the width and height of the windows, the middle left out.
    rule : (float, float)
        Share of a window's largest squared magnitude, and squared magnitude, that an edge point
        has at least.
    directions : (64,) array, (15,) array, bool
        Cell of each direction; `TANGENTS`; as in `gradients.direction_bins`.
    counts : (N, K + 1 or more) array
        Filled with the points of each cell.

    Returns
    -------
    (N,) array
        Counts of all cells together.
    """
    (gx, gy), (across, up) = gradients, half
    height, width = gx.shape
    (table, tangents, _), cells = directions, counts.shape[1]
    if len(table) < 4 * (len(tangents) + 1) or (len(table) and table.max() >= cells):
        raise IndexError("the reference has fewer bins than the feature")
    if len(middles) == 0 or len(counts) < len(middles) or gy.shape != gx.shape:
        raise IndexError("there is no window, or no room for its counts")
    for x, y in middles:
        if not (0 <= x < width and 0 <= y < height):
            raise IndexError("a window is not among the gradients")
    strengths = np.empty((height, width), np.int32)
    for y in range(height):
        for x in range(width):
            along, down = np.int32(gx[y, x]), np.int32(gy[y, x])
            strengths[y, x] = along * along + down * down
    limits = _limits_of(strengths, middles, half, rule)
    points = _list_points(gradients, strengths, limits.min(), directions)
    totals = np.empty(len(middles), np.int64)
    for i in range(len(middles)):
        x, y = middles[i]
        left, right = max(x - across, 0), min(x + across + 1, width)
        window = left, max(y - up, 0), right, min(y + up + 1, height)
        totals[i] = _count_window(points, limits[i], window, counts[i])
    return totals
