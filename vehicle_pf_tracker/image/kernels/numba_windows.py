# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Similarities of many windows of one size with a reference, in numba.

Windows that lie close together share most of their pixels (`numba_sliding`). Those that lie far
apart are counted each by itself.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.kernels.numba_pixel_cells import joint_cells
from vehicle_pf_tracker.image.kernels.numba_placing import extent_of, place_windows
from vehicle_pf_tracker.image.kernels.numba_similarity import overlap
from vehicle_pf_tracker.image.kernels.numba_sliding import is_sliding_worthwhile, slide
from vehicle_pf_tracker.image.kernels.numba_types import (
    BIN_TABLE,
    CELL_PLANES,
    PAIR,
    POSITIONS,
    REACH,
    RECTANGLES,
    RGB_IMAGE,
    SCALE,
    Cells,
    Pixels,
    Reach,
    Reals,
    Scale,
    Table,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined
from vehicle_pf_tracker.image.windows.window import Positions


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
        result[i] = overlap(sums, values, total, roots)
    return result


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
    extent = extent_of(pixels)
    # Pairs of pixels have a column less than their windows: a middle may stand behind the last one.
    if min(extent) < 0 or extent[2] > width or extent[3] >= height:
        raise IndexError("a window is not among the cells")
    _check_cells(cells, scale[0])
    if is_sliding_worthwhile(cells, len(pixels), extent, reach, len(scale[0])):
        return slide(cells, pixels, extent, reach, scale)
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
