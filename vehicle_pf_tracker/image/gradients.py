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

"""The edge feature of P2: directions of the gradient at edge points (section III-C)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.window import (
    Bounds,
    Counted,
    CountedFeature,
    Grey,
    Positions,
    Window,
    areas,
    bin_counts,
    bounds,
    centres,
    covered_region,
    keep_inside,
    to_grey,
)

Strengths: TypeAlias = npt.NDArray[np.float32]
"""Squared magnitude of the gradient; integers below 2**24, so exact."""

DIRECTION_BINS = 64
"""Bins of the gradient's direction (P2, section III-C)."""


def squared_strength(gx: npt.NDArray[Any], gy: npt.NDArray[Any]) -> Strengths:
    """Squared magnitude of equation 7, in grey levels squared."""
    gx, gy = gx.astype(np.float32), gy.astype(np.float32)
    return np.asarray(gx * gx + gy * gy)


def squared_limits(peaks: Strengths, threshold: float, floor: float = 0.0) -> Strengths:
    """Least squared strength of edge points where the strongest has `peaks`.

    Parameters
    ----------
    peaks : array
        Squared strengths.
    threshold : float
        Share of the strongest gradient that makes an edge point.
    floor : float
        Gradient that an edge point has at least, whatever the strongest is.

    Returns
    -------
    array
        Infinite where there is no gradient at all: nothing is an edge point there.
    """
    limits = np.maximum(np.float32(threshold) ** 2 * peaks, np.float32(floor) ** 2)
    return np.asarray(np.where(peaks > 0, limits, np.inf), np.float32)


def direction_bins(
    gx: npt.NDArray[Any], gy: npt.NDArray[Any], *, signed: bool
) -> npt.NDArray[np.intp]:
    """Bin 0 to 63 of the direction in the image (x to the right, y down).

    Parameters
    ----------
    gx, gy : arrays of one shape
        Integers, not both zero.
    signed : bool
        False takes ``atan(gy / gx)``, which knows no opposite directions.

    Returns
    -------
    array
        -180 degrees is bin 0, 0 degrees the lower end of bin 32; 180 degrees is -180.
    """
    if not signed:
        fold = (gx < 0) | ((gx == 0) & (gy < 0))
        gx, gy = np.where(fold, -gx, gx), np.where(fold, -gy, gy)
    turns = np.arctan2(gy.astype(np.float64), gx.astype(np.float64)) / (2 * np.pi) + 0.5
    return np.floor(turns * DIRECTION_BINS).astype(np.intp) % DIRECTION_BINS


Indices: TypeAlias = npt.NDArray[np.intp]
LimitsOf: TypeAlias = Callable[[Strengths], Strengths]


def window_direction_counts(
    grey: Grey, windows: Bounds, limits_of: LimitsOf, *, signed: bool
) -> npt.NDArray[np.intp]:
    """Count edge points by direction, each window being an image of its own.

    Parameters
    ----------
    grey : (H, W) array
        Grey levels.
    windows : Bounds
        Rectangles in `grey`, arrays of shape (N,).
    limits_of : callable
        Squared strength that makes an edge point, from the windows' largest ones.
    signed : bool
        As in `direction_bins`.

    Returns
    -------
    (N, 64) array
    """
    parts = [_counts(grey, part, limits_of, signed=signed) for part in _chunks(windows)]
    return np.concatenate(parts)


def _chunks(windows: Bounds) -> Iterator[Bounds]:
    largest = (windows.right - windows.left).max() * (windows.bottom - windows.top).max()
    size = max(_CHUNK // int(largest), 1)
    for start in range(0, len(windows.left), size):
        yield Bounds(*(side[start : start + size] for side in windows))


def _counts(
    grey: Grey, windows: Bounds, limits_of: LimitsOf, *, signed: bool
) -> npt.NDArray[np.intp]:
    rows, row_exists = _mirrored(windows.top, windows.bottom)
    columns, column_exists = _mirrored(windows.left, windows.right)
    pixels = grey[rows[:, :, np.newaxis], columns[:, np.newaxis, :]].astype(np.int32)
    along_x = pixels[:, :, 2:] - pixels[:, :, :-2]
    along_y = pixels[:, 2:] - pixels[:, :-2]
    gx = along_x[:, :-2] + 2 * along_x[:, 1:-1] + along_x[:, 2:]
    gy = along_y[:, :, :-2] + 2 * along_y[:, :, 1:-1] + along_y[:, :, 2:]
    strength = squared_strength(gx, gy)
    strength *= row_exists[:, :, np.newaxis] & column_exists[:, np.newaxis, :]
    limits = limits_of(strength.max(axis=(1, 2)))
    edges = np.nonzero(strength >= limits[:, np.newaxis, np.newaxis])
    bins = direction_bins(gx[edges], gy[edges], signed=signed)
    count = len(windows.left)
    flat = np.bincount(edges[0] * DIRECTION_BINS + bins, minlength=count * DIRECTION_BINS)
    return flat.reshape(count, DIRECTION_BINS)


def _mirrored(first: Indices, end: Indices) -> tuple[Indices, npt.NDArray[np.bool_]]:
    """Pixel numbers from one before each window to one behind the longest, mirrored into it.

    Returns
    -------
    (N, longest + 2) array of pixel numbers, and (N, longest) array that tells which pixels exist
    """
    steps = np.arange(-1, (end - first).max() + 1)
    index = first[:, np.newaxis] + np.abs(steps)
    last = end[:, np.newaxis] - 1
    exists = index[:, 1:-1] <= last
    mirrored = np.where(index > last, 2 * last - index, index)
    return np.clip(mirrored, first[:, np.newaxis], last), exists


Counts: TypeAlias = npt.NDArray[np.int64]

_NO_EDGE = DIRECTION_BINS
_CHUNK = 1_000_000
"""Pixels of windows, or pairs of window and edge point, handled at once: 8 MB per float64 array."""


@dataclass(frozen=True)
class GradientDirections(CountedFeature):
    """64 bins of gradient direction, -180 to 180 degrees, of a window's edge points.

    Parameters
    ----------
    threshold : float
        Edge points have at least this share of the window's strongest gradient (printed: 0.8;
        interpretation 14).
    in_frame : bool
        Take the gradient in the frame; False takes it in each window by itself, mirrored at its
        border, as printed (interpretation 14).
    signed : bool
        Distinguish dark-to-light from light-to-dark; False takes the printed ``atan``, which folds
        opposite directions into the middle 32 bins (interpretation 13).
    floor : float
        Gradient that an edge point has at least (a step of one grey level makes 4). Without one, a
        window of nothing but noise is full of edge points.
    """

    threshold: float = 0.3
    in_frame: bool = True
    signed: bool = True
    floor: float = 0.0

    bins = DIRECTION_BINS

    def counts(
        self, frame: Frame, positions: Positions, window: Window, active: npt.NDArray[np.intp]
    ) -> Counted:
        """Count windows; see `CountedFeature.counts`."""
        in_image = bounds(frame, positions, window)
        # One pixel more makes every gradient in the windows that of the whole frame.
        region, windows = covered_region(frame, in_image, margin=1)
        grey = to_grey(region)
        if not self.in_frame:
            counts = window_direction_counts(grey, windows, self.limits, signed=self.signed)
            return Counted(counts[:, active], counts.sum(axis=1))
        gx, gy = (
            np.asarray(cv2.Sobel(grey, cv2.CV_16S, dx, 1 - dx, ksize=3), np.int16) for dx in (1, 0)
        )
        strength = squared_strength(gx, gy)
        corner = in_image.left[0] - windows.left[0], in_image.top[0] - windows.top[0]
        middles = centres(keep_inside(frame, positions)) - corner
        limits = self.limits(window_peaks(strength, middles, window))
        points = _edge_points(gx, gy, strength, limits, signed=self.signed)
        return _count_points(points, strength.shape, limits, windows, active)

    def limits(self, peaks: Strengths) -> Strengths:
        """Least squared strength of edge points in windows whose strongest have `peaks`."""
        return squared_limits(peaks, self.threshold, self.floor)


class EdgePoints(NamedTuple):
    """Candidates for edge points: row, column, squared strength and bin, each of shape (M,)."""

    y: npt.NDArray[np.intp]
    x: npt.NDArray[np.intp]
    strength: Strengths
    bin: npt.NDArray[np.intp]

    def where(self, chosen: npt.NDArray[Any]) -> EdgePoints:
        """Points chosen by a mask or by their numbers."""
        return EdgePoints(*(column[chosen] for column in self))


def window_peaks(strength: Strengths, middles: npt.NDArray[np.intp], window: Window) -> Strengths:
    """Largest strength in each window, shape (N,); `middles` are the windows' own pixels (N, 2)."""
    height, width = strength.shape
    half = min(window.half_width, width), min(window.half_height, height)
    kernel = np.ones((2 * half[1] + 1, 2 * half[0] + 1), np.uint8)
    highest = np.asarray(cv2.dilate(strength, kernel), np.float32)
    return highest[middles[:, 1], middles[:, 0]]


def _edge_points(
    gx: npt.NDArray[np.int16],
    gy: npt.NDArray[np.int16],
    strength: Strengths,
    limits: Strengths,
    *,
    signed: bool,
) -> EdgePoints:
    y, x = np.nonzero(strength >= limits.min())
    return EdgePoints(y, x, strength[y, x], direction_bins(gx[y, x], gy[y, x], signed=signed))


def _count_points(
    points: EdgePoints,
    shape: tuple[int, ...],
    limits: Strengths,
    windows: Bounds,
    active: npt.NDArray[np.intp],
) -> Counted:
    """Count points by direction: those above every limit in planes, the few others one by one."""
    certain = points.strength >= limits.max(initial=0.0, where=np.isfinite(limits))
    sure = points.where(certain)
    indices = np.full(shape, _NO_EDGE, np.uint8)
    indices[sure.y, sure.x] = sure.bin
    sums = bin_counts(indices, np.append(active, _NO_EDGE), _NO_EDGE + 1, windows)
    doubtful = _compare(points.where(~certain), limits, windows)
    totals = areas(windows) - sums[:, -1] + doubtful.sum(axis=1)
    return Counted(sums[:, :-1] + doubtful[:, active], totals)


def _compare(points: EdgePoints, limits: Strengths, windows: Bounds) -> Counts:
    """Count the points of each bin that each window contains and lets pass, shape (N, 64)."""
    counts = np.zeros((len(limits), DIRECTION_BINS), np.int64)
    if len(points.y) == 0:
        return counts
    y, x, strength, bins = points.where(np.argsort(points.bin, kind="stable"))
    first = np.flatnonzero(np.diff(bins, prepend=-1))
    # Narrow numbers, since this compares every window with every point.
    y, x = y.astype(np.int16), x.astype(np.int16)
    size = max(_CHUNK // len(bins), 1)
    for start in range(0, len(limits), size):
        part = slice(start, start + size)
        left, top, right, bottom = (side[part, np.newaxis].astype(np.int16) for side in windows)
        passes = strength >= limits[part, np.newaxis]
        passes &= (x >= left) & (x < right)
        passes &= (y >= top) & (y < bottom)
        counts[part, bins[first]] = np.add.reduceat(passes, first, axis=1, dtype=np.int64)
    return counts
