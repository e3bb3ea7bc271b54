# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Similarities of windows that lie close together and share their pixels, in numba.

A histogram of every column, as high as a window, follows the windows' centres from row to row, and
the sum of the columns in a window follows them along a row. Its similarity is then taken only where
a window was asked for.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.image.kernels.numba_similarity import overlap
from vehicle_pf_tracker.image.kernels.numba_types import (
    Cells,
    Columns,
    Counts,
    Extent,
    Pixels,
    Reach,
    Reals,
    Scale,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import inlined

# Costs, roughly in cycles; they decide about the way to a result, and not about the result.
_PIXEL = 4
"""Entering or leaving of a pixel in a histogram: its cell is read, and a count read and written."""
_STEP = 10
"""Move to the next column, whatever the number of bins: tests of the border, a choice."""
_BINS_AT_ONCE = 8
"""Bins that are added in a cycle: eight 16-bit counts have 128 bits, a choice."""


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
def slide(cells: Cells, pixels: Pixels, extent: Extent, reach: Reach, scale: Scale) -> Reals:
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
                rho = overlap(sums, values, planes * across * (bottom - top), roots)
            while i:
                result[i - 1] = rho
                i = others[i - 1]
    return result


@inlined
def is_sliding_worthwhile(
    cells: Cells, count: int, extent: Extent, reach: Reach, bins: int
) -> bool:
    """Weigh what the two ways to the same result cost, roughly in cycles."""
    x0, y0, x1, y1 = extent
    across = 2 * reach[0] + 1
    step = bins // _BINS_AT_ONCE
    each_row = (x1 - x0 + 1) * (step + _STEP) + across * step
    sliding = _PIXEL * cells.size + (y1 - y0 + 1) * each_row
    return sliding <= count * (_PIXEL * len(cells) * across * (2 * reach[2] + 1) + bins)
