# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Counts and similarities of many windows of one size, in numba.

Windows that lie close together share most of their pixels. A histogram of every column, as high as
a window, follows the windows' centres from row to row, and the sum of the columns in a window
follows them along a row. Its similarity is then taken only where a window was asked for. Windows
that lie far apart are counted each by itself.
"""

from __future__ import annotations

import math

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.kernels.kernel import compiled, inlined
from vehicle_pf_tracker.image.kernels.numba_types import (
    BIN_TABLE,
    CELL_PLANES,
    EXTENT,
    PAIR,
    POSITIONS,
    REACH,
    RECTANGLES,
    RGB_IMAGE,
    SCALE,
    Cells,
    Columns,
    Counts,
    Extent,
    Pixels,
    Reach,
    Reals,
    Scale,
    Table,
)
from vehicle_pf_tracker.image.window import Positions

# Costs, roughly in cycles; they decide about the way to a result, and not about the result.
_PIXEL = 4
"""Entering or leaving of a pixel in a histogram: its cell is read, and a count read and written."""
_STEP = 10
"""Move to the next column, whatever the number of bins: tests of the border, a choice."""
_BINS_AT_ONCE = 8
"""Bins that are added in a cycle: eight 16-bit counts have 128 bits, a choice."""


@inlined
def _extent(pixels: Pixels) -> Extent:
    """Return the least x and y, and the largest, of windows' middles, px."""
    x0 = x1 = pixels[0, 0]
    y0 = y1 = pixels[0, 1]
    for i in range(len(pixels)):
        x0 = min(x0, pixels[i, 0])
        y0 = min(y0, pixels[i, 1])
        x1 = max(x1, pixels[i, 0])
        y1 = max(y1, pixels[i, 1])
    return x0, y0, x1, y1


@compiled(f"Tuple(({RECTANGLES}, {EXTENT}))", POSITIONS, PAIR, PAIR, "int64")
def place_windows(
    positions: Positions, size: tuple[int, int], half: tuple[int, int], margin: int
) -> tuple[Pixels, Extent]:
    """Find the part of a frame that windows cover, and their middles in it.

    Parameters
    ----------
    positions : (N, 2) array
        Centres of the windows, px; rounded and kept inside as in `window.bounds`.
    size, half : (int, int)
        Width and height of the frame; those of a window beside and above its middle.
    margin : int
        Pixels around the windows that are covered too.

    Returns
    -------
    (N, 2) array, (int, int, int, int)
        Pixel x, y of each window's middle in the part; left, top, right, bottom of the part.
    """
    width, height = size
    beside, above = half
    if len(positions) == 0 or positions.shape[1] != 2 or min(width, height) < 1:
        raise IndexError("there is no window, or no pixel")
    pixels = np.empty((len(positions), 2), np.int64)
    for i in range(len(positions)):
        pixels[i, 0] = min(max(np.int64(np.rint(positions[i, 0] - 0.5)), 0), width - 1)
        pixels[i, 1] = min(max(np.int64(np.rint(positions[i, 1] - 0.5)), 0), height - 1)
    x0, y0, x1, y1 = _extent(pixels)
    left, top = max(x0 - beside - margin, 0), max(y0 - above - margin, 0)
    right, bottom = min(x1 + beside + 1 + margin, width), min(y1 + above + 1 + margin, height)
    for i in range(len(pixels)):
        pixels[i, 0] -= left
        pixels[i, 1] -= top
    return pixels, (left, top, right, bottom)


@compiled(CELL_PLANES, RGB_IMAGE, "int64", BIN_TABLE)
def joint_cells(pixels: Frame, bits: int, table: Table) -> Cells:
    """Cells of joint RGB bins, one plane."""
    height, width, channels = pixels.shape
    if channels != 3 or not 1 <= bits <= 8 or len(table) < 1 << (3 * bits):
        raise IndexError("the reference has fewer bins than the feature")
    cells = np.empty((1, height, width), np.uint16)
    drop = 8 - bits
    for y in range(height):
        for x in range(width):
            red = pixels[y, x, 0]
            green = pixels[y, x, 1]
            blue = pixels[y, x, 2]
            number = ((red >> drop) << (2 * bits)) | ((green >> drop) << bits) | (blue >> drop)
            cells[0, y, x] = table[number]
    return cells


@inlined
def _check_cells(cells: Cells, values: Reals) -> None:
    """Raise an error where a cell has no value; one pass, a hundredth of what follows."""
    largest = np.uint16(0)
    for plane in range(cells.shape[0]):
        for y in range(cells.shape[1]):
            for x in range(cells.shape[2]):
                largest = max(largest, cells[plane, y, x])
    if largest >= len(values):
        raise IndexError("a cell is not among those of the reference")


@inlined
def _overlap(counts: Counts, values: Reals, total: int, roots: Reals) -> float:
    """Bhattacharyya coefficient of counts with a reference, whose roots are `values`."""
    overlap = 0.0
    # A table of roots is faster than roots, as far as it stays in the cache.
    if total < len(roots):
        for k in range(len(values)):
            overlap += values[k] * roots[counts[k]]
    else:
        for k in range(len(values)):
            overlap += values[k] * math.sqrt(np.float64(counts[k]))
    return min(overlap / math.sqrt(max(total, 1)), 1.0)


@inlined
def _follow_rows(columns: Columns, cells: Cells, rows: Pixels, top: int, bottom: int) -> None:
    """Take the column histograms of rows[0]:rows[1] to those of top:bottom, which is not above."""
    width = cells.shape[2]
    for row in range(rows[1], bottom):
        for plane in range(cells.shape[0]):
            for x in range(width):
                columns[x, cells[plane, row, x]] += np.uint16(1)
    for row in range(rows[0], min(top, bottom)):
        for plane in range(cells.shape[0]):
            for x in range(width):
                columns[x, cells[plane, row, x]] -= np.uint16(1)
    rows[0], rows[1] = top, bottom


@inlined
def _gather(counts: Counts, columns: Columns, left: int, right: int) -> None:
    """Sum the columns from left to right."""
    for k in range(len(counts)):
        counts[k] = 0
    for x in range(left, right):
        for k in range(len(counts)):
            counts[k] += np.int32(columns[x, k])


@inlined
def _shift(counts: Counts, columns: Columns, leaving: int, entering: int) -> None:
    """Let a column leave and one enter, where they exist."""
    # A window that the border cuts has no column there to lose, or to gain.
    if leaving >= 0 and entering < len(columns):
        for k in range(len(counts)):
            counts[k] += np.int32(columns[entering, k]) - np.int32(columns[leaving, k])
    elif entering < len(columns):
        for k in range(len(counts)):
            counts[k] += np.int32(columns[entering, k])
    elif leaving >= 0:
        for k in range(len(counts)):
            counts[k] -= np.int32(columns[leaving, k])


@inlined
def _listed(pixels: Pixels, x0: int, y0: int, heads: Pixels) -> Pixels:
    """List the windows of each pixel, from 1: the last in `heads`, then each one's predecessor."""
    for y in range(heads.shape[0]):
        for x in range(heads.shape[1]):
            heads[y, x] = 0
    others = np.empty(len(pixels), np.int64)
    for i in range(len(pixels)):
        x, y = pixels[i, 0] - x0, pixels[i, 1] - y0
        others[i] = heads[y, x]
        heads[y, x] = i + 1
    return others


@inlined
def _asked(heads: Pixels, row: int) -> tuple[int, int]:
    """First column of a row that has a window, and the one after the last; equal without any."""
    first, end = 0, heads.shape[1]
    while first < end and heads[row, first] == 0:
        first += 1
    while end > first and heads[row, end - 1] == 0:
        end -= 1
    return first, end


@inlined
def _slide(cells: Cells, pixels: Pixels, extent: Extent, reach: Reach, scale: Scale) -> Reals:
    """Compare windows that lie close together; parameters as for `compare_windows`."""
    planes, height, width = cells.shape
    left, right, up = reach
    x0, y0, x1, y1 = extent
    values, roots = scale
    heads = np.empty((y1 - y0 + 1, x1 - x0 + 1), np.int64)
    others = _listed(pixels, x0, y0, heads)
    columns = np.zeros((width, len(values)), np.uint16)
    sums = np.empty(len(values), np.int32)
    rows = np.empty(2, np.int64)
    rows[0] = rows[1] = 0
    result = np.empty(len(pixels))
    for y in range(y0, y1 + 1):
        # 1. Between the first and last window of a row the sum slides; beyond, nothing is asked.
        skipped, end = _asked(heads, y - y0)
        if skipped == end:
            continue
        top = max(y - up, 0)
        bottom = min(y + up + 1, height)
        # 2. Rows ascend, so that each row of pixels enters the columns once, and leaves them once.
        _follow_rows(columns, cells, rows, top, bottom)
        first = x0 + skipped
        _gather(sums, columns, max(first - left, 0), min(first + right, width))
        for x in range(first, x0 + end):
            if x > first:
                _shift(sums, columns, x - left - 1, x + right - 1)
            # 3. Windows on one pixel are the same: compared once for all particles there.
            i = heads[y - y0, x - x0]
            if i:
                across = min(x + right, width) - max(x - left, 0)
                rho = _overlap(sums, values, planes * across * (bottom - top), roots)
            while i:
                result[i - 1] = rho
                i = others[i - 1]
    return result


@inlined
def _compare_each(cells: Cells, rectangles: Pixels, scale: Scale) -> Reals:
    """Compare windows one after the other; parameters as for `compare_windows`."""
    planes, height, width = cells.shape
    values, roots = scale
    _check_cells(cells, values)
    sums = np.empty(len(values), np.int32)
    result = np.empty(len(rectangles))
    for i in range(len(rectangles)):
        left = rectangles[i, 0]
        top = rectangles[i, 1]
        right = rectangles[i, 2]
        bottom = rectangles[i, 3]
        if left < 0 or top < 0 or right > width or bottom > height:
            raise IndexError("a window is not among the cells")
        for k in range(len(sums)):
            sums[k] = 0
        for plane in range(planes):
            for y in range(top, bottom):
                for x in range(left, right):
                    sums[cells[plane, y, x]] += 1
        total = planes * max(right - left, 0) * (bottom - top)
        result[i] = _overlap(sums, values, total, roots)
    return result


@inlined
def _is_sliding_worthwhile(
    cells: Cells, count: int, extent: Extent, reach: Reach, bins: int
) -> bool:
    """Weigh what the two ways to the same result cost, roughly in cycles."""
    x0, y0, x1, y1 = extent
    across = 2 * reach[0] + 1
    step = bins // _BINS_AT_ONCE
    each_row = (x1 - x0 + 1) * (step + _STEP) + across * step
    sliding = _PIXEL * cells.size + (y1 - y0 + 1) * each_row
    return sliding <= count * (_PIXEL * len(cells) * across * (2 * reach[2] + 1) + bins)


@compiled("float64[::1]", CELL_PLANES, RECTANGLES, REACH, SCALE)
def compare_windows(cells: Cells, pixels: Pixels, reach: Reach, scale: Scale) -> Reals:
    """Compare windows with a reference, and return their Bhattacharyya coefficients (N,).

    Parameters
    ----------
    cells, pixels : (P, H, W) array, (N, 2) array
        Cells of the part that all windows cover; middle x, y of each window in it.
    reach : (int, int, int)
        Pixels of a window to the left of its middle, to the right of it counting the middle
        itself, and above it (as many as below).
    scale : (K + 1 or more,) array, (M,) array
        Square roots of the reference at the active bins, followed by zeros; and those of 0, 1, 2, …
    """
    _, height, width = cells.shape
    left, right, up = reach
    if len(pixels) == 0 or min(left, right, up) < 0:
        raise IndexError("there is no window, or no pixel")
    extent = _extent(pixels)
    # Pairs of pixels have a column less than their windows: a middle may stand behind the last one.
    if min(extent) < 0 or extent[2] > width or extent[3] >= height:
        raise IndexError("a window is not among the cells")
    _check_cells(cells, scale[0])
    if _is_sliding_worthwhile(cells, len(pixels), extent, reach, len(scale[0])):
        return _slide(cells, pixels, extent, reach, scale)
    rectangles = np.empty((len(pixels), 4), np.int64)
    for i in range(len(pixels)):
        x = pixels[i, 0]
        y = pixels[i, 1]
        rectangles[i, 0], rectangles[i, 1] = max(x - left, 0), max(y - up, 0)
        rectangles[i, 2], rectangles[i, 3] = min(x + right, width), min(y + up + 1, height)
    return _compare_each(cells, rectangles, scale)


@compiled("float64[::1]", RGB_IMAGE, POSITIONS, "int64", PAIR, BIN_TABLE, SCALE)
def compare_joint(
    frame: Frame, positions: Positions, bits: int, half: tuple[int, int], table: Table, scale: Scale
) -> Reals:
    """Compare windows of joint colours in one call, the main cost of most trackers' steps.

    `half` is as for `place_windows`; the rest is as for `joint_cells` and `compare_windows`.
    """
    height, width, _ = frame.shape
    beside, above = half
    if min(beside, above) < 0:
        raise IndexError("there is no window, or no pixel")
    pixels, (left, top, right, bottom) = place_windows(positions, (width, height), half, 0)
    if (right - left) * (bottom - top) <= len(pixels) * (2 * beside + 1) * (2 * above + 1):
        cells = joint_cells(frame[top:bottom, left:right], bits, table)
        return compare_windows(cells, pixels, (beside, beside + 1, above), scale)
    result = np.empty(len(pixels))
    rectangle = np.empty((1, 4), np.int64)
    rectangle[0, 0] = rectangle[0, 1] = 0
    for i in range(len(pixels)):  # they share few pixels
        x, y = pixels[i, 0] + left, pixels[i, 1] + top
        part = frame[max(y - above, 0) : y + above + 1, max(x - beside, 0) : x + beside + 1]
        cells = joint_cells(part, bits, table)
        rectangle[0, 2] = cells.shape[2]
        rectangle[0, 3] = cells.shape[1]
        result[i] = _compare_each(cells, rectangle, scale)[0]
    return result
