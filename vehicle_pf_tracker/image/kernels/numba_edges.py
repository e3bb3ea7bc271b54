# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Edge points of many windows, each with a limit of its own, in numba."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.kernels.numba_gradients import IMAGES, Images, Strengths
from vehicle_pf_tracker.image.kernels.numba_placing import extent_of
from vehicle_pf_tracker.image.kernels.numba_types import (
    BIN_TABLE,
    COUNTS,
    PAIR,
    RECTANGLES,
    Counts,
    Rectangles,
    Table,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined
from vehicle_pf_tracker.image.windows.gradients import DIRECTION_BINS

Points: TypeAlias = tuple[Strengths, Table, Strengths]
Tangents: TypeAlias = npt.NDArray[np.float64]
Numbers: TypeAlias = npt.NDArray[np.int64]

_NUMBERS = "int64[::1]"
"""One number of each window, (N,)."""
_TANGENTS = "Array(float64, 1, 'C', readonly=True)"
"""Type of `TANGENTS`."""

_NEVER = 1 << 31
"""Limit that nothing passes: squared magnitudes are at most 2 * 1020²."""

_RANGE = 4
"""Ratio of limits above which windows are counted from lists of their own: a window of faint edges
lets almost every pixel pass, most of which other windows would then skip one by one. A choice of
speed alone: 4 in squares is a gradient twice as strong."""

TANGENTS: Tangents = np.tan(np.arange(1, DIRECTION_BINS // 4) * (2 * np.pi / DIRECTION_BINS))
"""Tangents of the directions between the bins of a quarter turn."""
TANGENTS.flags.writeable = False


@inlined
def direction_bin(gx: int, gy: int, tangents: Tangents, signed: bool) -> int:
    """Bin 0 to 63, as `gradients.direction_bins` has it; integers are never near a tangent."""
    # As the printed atan: half a turn, and a vertical gradient downwards.
    if not signed and (gx < 0 or (gx == 0 and gy < 0)):
        gx, gy = -gx, -gy
    if gx > 0 and gy >= 0:
        first = 32
        along = gx
        across = gy
    elif gy > 0:
        first = 48
        along = gy
        across = -gx
    elif gx < 0:
        first = 0
        along = -gx
        across = -gy
    else:
        first = 16
        along = -gy
        across = gx
    # Fifteen products and comparisons, in place of an arctangent.
    for tangent in tangents:
        # A sum of comparisons has no branch to be mispredicted.
        first += across >= along * tangent
    return first


@inlined
def _raise_to(numbers: Strengths, others: Strengths) -> None:
    """Replace numbers by the larger ones of another array, as far as both go."""
    for x in range(min(len(numbers), len(others))):
        numbers[x] = max(numbers[x], others[x])


@inlined
def _copy(numbers: Strengths, copied: Strengths) -> None:
    """Copy an array into one of the same length."""
    for x in range(len(numbers)):
        copied[x] = numbers[x]


@inlined
def _peaks_of(strengths: Strengths, middles: Rectangles, half: tuple[int, int]) -> Strengths:
    """Largest squared magnitude in each window, shape (N,).

    Maxima over 1, 2, 4, ... rows, then columns; two of the last that overlap make those over a
    window's. So the work does not grow with the windows, of which thousands share their pixels.
    """
    across, up = half
    height, width = strengths.shape
    x0, y0, x1, y1 = extent_of(middles)
    # From the first pixel of the first window; 0 beyond the image, where there are no edges.
    rows = np.zeros((y1 - y0 + 2 * up + 1, x1 - x0 + 2 * across + 1), np.int32)
    left = max(x0 - across, 0)
    right = min(x1 + across + 1, width)
    for y in range(max(y0 - up, 0), min(y1 + up + 1, height)):
        for x in range(left, right):
            rows[y - y0 + up, x - x0 + across] = strengths[y, x]
    # Windows of a power of two that overlap cover any height: a maximum may count a pixel twice.
    span = 1
    while 2 * span <= 2 * up + 1:
        for y in range(len(rows) - span):
            _raise_to(rows[y], rows[y + span])
        span *= 2
    kept = np.empty(rows.shape[1], np.int32)
    for y in range(y1 - y0 + 1):
        row = rows[y]
        _raise_to(row, rows[y + 2 * up + 1 - span])
        along = 1
        while 2 * along <= 2 * across + 1:
            # In a copy: a maximum in place would read what it has just raised.
            _copy(row, kept)
            _raise_to(row, kept[along:])
            along *= 2
        _copy(row, kept)
        _raise_to(row, kept[2 * across + 1 - along :])
    peaks = np.empty(len(middles), np.int32)
    for i in range(len(middles)):
        peaks[i] = rows[middles[i, 1] - y0, middles[i, 0] - x0]
    return peaks


@inlined
def _limits_of(peaks: Strengths, rule: tuple[float, float]) -> Numbers:
    """Least squared magnitude that counts in each window; see `GradientDirections.counts`."""
    share, least = rule
    limits = np.empty(len(peaks), np.int64)
    for i in range(len(peaks)):
        # A window without any gradient has no edge point, whatever its share of nothing is.
        limits[i] = _NEVER
        if peaks[i] > 0:
            # In integers, the comparison of a million pixels needs no conversion.
            limits[i] = np.int64(math.ceil(max(share * np.float32(peaks[i]), least)))
    return limits


@inlined
def _cut(
    middles: Rectangles, i: int, half: tuple[int, int], shape: tuple[int, int]
) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of a window, cut at the border."""
    x, y = middles[i]
    across, up = half
    height, width = shape
    left = max(x - across, 0)
    right = min(x + across + 1, width)
    return left, max(y - up, 0), right, min(y + up + 1, height)


@inlined
def _lowest(limits: Numbers, is_open: npt.NDArray[np.bool_]) -> int:
    """Lowest limit of the windows that are not counted yet; `_NEVER` if there are none."""
    lowest = _NEVER
    for i in range(len(limits)):
        if is_open[i]:
            lowest = min(lowest, np.int64(limits[i]))
    return lowest


@inlined
def _area_of(
    limits: Numbers,
    is_open: npt.NDArray[np.bool_],
    lowest: int,
    windows: tuple[Rectangles, tuple[int, int], tuple[int, int]],
) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of what the windows cover that are counted from the same list."""
    middles, half, shape = windows
    left, top, right, bottom = shape[1], shape[0], 0, 0
    for i in range(len(limits)):
        if is_open[i] and limits[i] <= _RANGE * lowest:
            x0, y0, x1, y1 = _cut(middles, i, half, shape)
            left, top = min(left, x0), min(top, y0)
            right, bottom = max(right, x1), max(bottom, y1)
    return left, top, right, bottom


@inlined
def _list_points(
    images: Images,
    limit: int,
    area: tuple[int, int, int, int],
    directions: tuple[Table, Tangents, bool],
) -> Points:
    """List the pixels of an area that pass a limit, row by row.

    Returns
    -------
    (H, W + 1), (M,), (M,) arrays
        Number of the first point that is not before a pixel; cells and strengths of the points.
    """
    gx, gy, strengths = images
    table, tangents, signed = directions
    left, top, right, bottom = area
    index = np.empty((strengths.shape[0], strengths.shape[1] + 1), np.int32)
    size = (right - left) * (bottom - top)
    cells = np.empty(size, np.uint16)
    passed = np.empty(size, np.int32)
    found = np.empty(right - left, np.int32)
    count = 0
    for y in range(top, bottom):
        here = 0
        for x in range(left, right):
            index[y, x] = count + here
            # Written always, kept only where it passes: no branch to be mispredicted.
            found[here] = x
            here += strengths[y, x] >= limit
        index[y, right] = count + here
        # Directions of these alone: most px of a window are no edge points.
        for i in range(here):
            x = found[i]
            number = direction_bin(np.int64(gx[y, x]), np.int64(gy[y, x]), tangents, signed)
            cells[count + i] = table[number]
            passed[count + i] = strengths[y, x]
        count += here
    return index, cells, passed


@inlined
def _count_window(
    points: Points, limit: int, window: tuple[int, int, int, int], counts: Strengths
) -> int:
    """Fill the counts of one window's points that pass its limit, and return their number."""
    index, cells, strengths = points
    left, top, right, bottom = window
    for k in range(len(counts)):
        counts[k] = 0
    total = 0
    for y in range(top, bottom):
        # An unsigned index needs no test for counting from the end.
        for point in range(np.uint32(index[y, left]), np.uint32(index[y, right])):
            passes = strengths[point] >= limit
            counts[cells[point]] += np.int32(passes)
            total += passes
    return total


@inlined
def _check(
    images: Images,
    middles: Rectangles,
    half: tuple[int, int],
    directions: tuple[Table, Tangents, bool],
    counts: Counts,
) -> None:
    """Raise an error where an index would lie outside an array."""
    height, width = images[2].shape
    table, tangents, _ = directions
    # Once per call: the loops trust every index, and numba tests none.
    highest = 0
    for cell in table:
        highest = max(highest, np.int64(cell))
    if len(table) < 4 * (len(tangents) + 1) or highest >= counts.shape[1]:
        raise IndexError("the reference has fewer bins than the feature")
    if images[0].shape != images[2].shape or images[1].shape != images[2].shape:
        raise IndexError("the gradients are not all of one image")
    if len(middles) == 0 or len(counts) < len(middles) or min(half) < 0:
        raise IndexError("there is no window, or no room for its counts")
    for i in range(len(middles)):
        x, y = middles[i]
        if not (0 <= x < width and 0 <= y < height):
            raise IndexError("a window is not among the gradients")


@compiled(
    _NUMBERS,
    IMAGES,
    RECTANGLES,
    PAIR,
    "UniTuple(float32, 2)",
    f"Tuple(({BIN_TABLE}, {_TANGENTS}, boolean))",
    COUNTS,
)
def count_edges(
    images: Images,
    middles: Rectangles,
    half: tuple[int, int],
    rule: tuple[float, float],
    directions: tuple[Table, Tangents, bool],
    counts: Counts,
) -> Numbers:
    """Count the edge points of windows by the cells of their directions.

    Parameters
    ----------
    images : three (H, W) arrays
        As `numba_gradients.gradients` makes them, of the part of the frame that has all windows in
        it, and one pixel more where there is one.
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
    _check(images, middles, half, directions, counts)
    shape = images[2].shape
    limits = _limits_of(_peaks_of(images[2], middles, half), rule)
    totals = np.zeros(len(middles), np.int64)
    is_open = np.empty(len(limits), np.bool_)
    for i in range(len(limits)):
        # A closed window has its counts; one without edges is closed from the beginning.
        is_open[i] = limits[i] != _NEVER
        for k in range(counts.shape[1]):
            counts[i, k] = 0
    while True:
        # From the lowest limit on: each round lists points once for all windows of its range.
        lowest = _lowest(limits, is_open)
        if lowest == _NEVER:
            return totals
        area = _area_of(limits, is_open, lowest, (middles, half, shape))
        points = _list_points(images, lowest, area, directions)
        for i in range(len(limits)):
            if is_open[i] and limits[i] <= _RANGE * lowest:
                window = _cut(middles, i, half, shape)
                totals[i] = _count_window(points, limits[i], window, counts[i])
                is_open[i] = False
