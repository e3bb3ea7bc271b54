# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Edge points of many windows, each with a limit of its own, in numba.

All is laid out over the field: the smallest rectangle that has every window whole. Where it reaches
beyond the image there is no gradient, not even one of zero, so that no window has to be cut.
Squared magnitudes are integers, and so are the limits that they are compared with.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.gradients import DIRECTION_BINS, GradientDirections
from vehicle_pf_tracker.image.kernels.numba_inputs import CellTable, Placement
from vehicle_pf_tracker.image.kernels.numba_jit import RECTANGLES, TABLE, Table, compiled, inlined
from vehicle_pf_tracker.image.kernels.numba_windows import PAIR, QUAD, Counts, Pixels
from vehicle_pf_tracker.image.window import Grey, to_grey

Gradients: TypeAlias = npt.NDArray[np.int16]
Strengths: TypeAlias = npt.NDArray[np.int32]
Images: TypeAlias = tuple[Gradients, Gradients, Strengths]
Points: TypeAlias = tuple[Strengths, Table, Strengths]
Tangents: TypeAlias = npt.NDArray[np.float64]
Numbers: TypeAlias = npt.NDArray[np.int64]

_NUMBERS = types.int64[::1]
_TANGENTS = types.Array(types.float64, 1, "C", readonly=True)

_NOWHERE = -1
"""Squared magnitude beyond the image."""

_NEVER = 1 << 62
"""Limit that nothing passes."""

_RANGE = 4
"""Ratio of limits above which windows are counted from lists of their own: a window of faint edges
lets almost every pixel pass, most of which other windows would then skip one by one."""

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
def _mirrored(index: int, length: int) -> int:
    """Index mirrored at the last pixel where it is beyond an end by one, as OpenCV does it."""
    if index < 0:
        return min(1, length - 1)
    return index if index < length else max(length - 2, 0)


@inlined
def _sobel(grey: Grey, images: Images, x0: int, y0: int) -> None:
    """Fill the gradients of the field from grey pixels whose first one is at x0, y0 in it."""
    gx, gy, strengths = images
    height, width = grey.shape
    smooth, slope = np.empty(width + 2, np.int16), np.empty(width + 2, np.int16)
    left, right = max(x0, 0), min(x0 + width, strengths.shape[1])
    strengths[:] = _NOWHERE
    for y in range(max(y0, 0), min(y0 + height, strengths.shape[0])):
        above, below = _mirrored(y - y0 - 1, height), _mirrored(y - y0 + 1, height)
        for x in range(width):
            over, here, under = grey[above, x], grey[y - y0, x], grey[below, x]
            smooth[x + 1] = np.int16(over) + np.int16(2) * np.int16(here) + np.int16(under)
            slope[x + 1] = np.int16(under) - np.int16(over)
        for row in (smooth, slope):
            row[0], row[width + 1] = row[1 + min(1, width - 1)], row[1 + max(width - 2, 0)]
        for x in range(right - left):
            column = np.uint64(x + left - x0)
            along = smooth[column + np.uint64(2)] - smooth[column]
            down = slope[column] + 2 * slope[column + np.uint64(1)] + slope[column + np.uint64(2)]
            gx[y, left + x], gy[y, left + x] = along, down
            strengths[y, left + x] = np.int32(along) * np.int32(along) + np.int32(down) * np.int32(
                down
            )


@inlined
def _window_peaks(strengths: Strengths, width: int, height: int) -> Strengths:
    """Largest number of the window that begins at each pixel, as far as windows fit."""
    # Maxima over 1, 2, 4, ... rows; two of the last that overlap make those over a window's.
    rows = strengths.copy()
    span = 1
    while 2 * span <= height:
        for y in range(len(rows) - span):
            _raise_to(rows[y], rows[y + span])
        span *= 2
    peaks = np.empty((len(rows) - height + 1, rows.shape[1] - width + 1), np.int32)
    kept = np.empty(rows.shape[1], np.int32)
    for y in range(len(peaks)):
        row, span_along = rows[y], 1
        _raise_to(row, rows[y + height - span])
        while 2 * span_along <= width:
            kept[:] = row
            _raise_to(row, kept[span_along:])
            span_along *= 2
        peaks[y] = row[: peaks.shape[1]]
        _raise_to(peaks[y], row[width - span_along :])
    return peaks


@inlined
def _raise_to(numbers: Strengths, others: Strengths) -> None:
    """Replace numbers by the larger ones of another array, as far as both go."""
    for x in range(min(len(numbers), len(others))):
        numbers[x] = max(numbers[x], others[x])


@inlined
def _limits_of(peaks: Strengths, firsts: Pixels, rule: tuple[float, float]) -> Numbers:
    """Least squared magnitude that counts in each window; see `gradients.squared_limits`."""
    share, least = rule
    limits = np.empty(len(firsts), np.int64)
    for i in range(len(firsts)):
        peak = peaks[firsts[i, 1], firsts[i, 0]]
        limits[i] = _NEVER
        if peak > 0:
            limits[i] = np.int64(math.ceil(max(share * np.float32(peak), least)))
    return limits


@inlined
def _list_points(
    images: Images,
    limit: int,
    area: tuple[int, int, int, int],
    table: Table,
    tangents: Tangents,
    signed: bool,
) -> Points:
    """List the pixels of an area that pass a limit, row by row.

    Returns
    -------
    (H, W + 1), (M,), (M,) arrays
        Number of the first point that is not before a pixel; cells and strengths of the points.
    """
    gx, gy, strengths = images
    left, top, right, bottom = area
    index = np.empty((strengths.shape[0], strengths.shape[1] + 1), np.int32)
    size = (right - left) * (bottom - top)
    cells, passed = np.empty(size, np.uint16), np.empty(size, np.int32)
    found = np.empty(right - left, np.int32)
    count = 0
    for y in range(top, bottom):
        here = 0
        for x in range(left, right):
            index[y, x] = count + here
            found[here] = x
            here += strengths[y, x] >= limit
        index[y, right] = count + here
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


@compiled(
    _NUMBERS(
        types.uint8[:, ::1],
        PAIR,
        types.Tuple((RECTANGLES, QUAD, PAIR)),
        types.UniTuple(types.float32, 2),
        types.Tuple((TABLE, _TANGENTS, types.boolean)),
        types.int32[:, ::1],
    )
)
def count_edges(
    grey: Grey,
    corner: tuple[int, int],
    windows: tuple[Pixels, tuple[int, int, int, int], tuple[int, int]],
    rule: tuple[float, float],
    directions: tuple[Table, Tangents, bool],
    counts: Counts,
) -> Numbers:
    """Count the edge points of windows by the cells of their directions.

    Parameters
    ----------
    grey : (H, W) array
        The part of the frame that has all windows in it, and one pixel more where there is one.
    corner : (int, int)
        x, y of its first pixel in the frame.
    windows : (N, 2) array, (int, int, int, int), (int, int)
        Centre x, y of each window in the frame; the least x and y and the largest x and y of them;
        half the width and height, the middle left out.
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
    (pixels, (x0, y0, x1, y1), (left, up)), (table, tangents, signed) = windows, directions
    width, height = 2 * left + 1, 2 * up + 1
    shape = y1 - y0 + height, x1 - x0 + width
    images = np.empty(shape, np.int16), np.empty(shape, np.int16), np.empty(shape, np.int32)
    _sobel(grey, images, corner[0] - x0 + left, corner[1] - y0 + up)
    firsts = pixels - np.array([x0, y0])
    limits = _limits_of(_window_peaks(images[2], width, height), firsts, rule)
    totals, done = np.zeros(len(pixels), np.int64), limits == _NEVER
    counts[:] = 0
    while not done.all():
        lowest = limits[~done].min()
        chosen = np.flatnonzero(~done & (limits <= _RANGE * lowest))
        done[chosen] = True
        xs, ys = firsts[chosen, 0], firsts[chosen, 1]
        area = xs.min(), ys.min(), xs.max() + width, ys.max() + height
        points = _list_points(images, lowest, area, table, tangents, signed)
        for i in chosen:
            x, y = firsts[i]
            totals[i] = _count_window(points, limits[i], (x, y, x + width, y + height), counts[i])
    return totals


class CellCounts(NamedTuple):
    """Counts of the table's cells (N, K + 1 or more), and of all bins together (N,)."""

    cells: Counts
    totals: Numbers


def count_directions(
    feature: GradientDirections, frame: Frame, placement: Placement, table: CellTable
) -> CellCounts:
    """Count edge points by direction, the gradient taken in the frame."""
    # One pixel more makes every gradient in the windows that of the whole frame.
    left, top, right, bottom = placement.covered(margin=1)
    counts = np.empty((len(placement.pixels), len(table.values)), np.int32)
    totals = count_edges(
        to_grey(frame[top:bottom, left:right]),
        (left, top),
        (placement.pixels, placement.extent, (placement.reach[0], placement.reach[2])),
        (np.float32(feature.threshold) ** 2, np.float32(feature.floor) ** 2),
        (table.cells, TANGENTS, feature.signed),
        counts,
    )
    return CellCounts(counts, totals)
