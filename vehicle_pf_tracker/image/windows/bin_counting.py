# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Exact counts of the pixels of each bin in many windows at once, by integral images."""

from __future__ import annotations

import functools
from typing import Any, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.windows.window import Bounds

_MOST_PLANES = 48
"""Bins integrated at once: OpenCV 5 takes 128 channels at most, and small blocks stay cached."""
_MOST_VALUES = 1 << 22
"""Bins times pixels integrated at once: bounds the memory to 32 MB of sums where windows are
huge, a choice."""
_EXACT_BITS = 53
"""Bits of an integer that a float64 represents exactly."""
Bins: TypeAlias = npt.NDArray[np.intp]
Counts: TypeAlias = npt.NDArray[np.int64]


def covered_region(frame: Frame, windows: Bounds, margin: int = 0) -> tuple[Frame, Bounds]:
    """View the pixels that the windows cover, and the windows relative to that view.

    Parameters
    ----------
    frame : (H, W, 3) array
        RGB.
    windows : Bounds
        Pixel rectangles in `frame`, arrays of shape (N,).
    margin : int
        Pixels kept around the windows, as far as the frame has them.
    """
    width, height = frame_size(frame)
    # All windows share this part: it is numbered once, and not once for each window.
    left = max(int(windows.left.min()) - margin, 0)
    top = max(int(windows.top.min()) - margin, 0)
    right = min(int(windows.right.max()) + margin, width)
    bottom = min(int(windows.bottom.max()) + margin, height)
    local = Bounds(
        windows.left - left, windows.top - top, windows.right - left, windows.bottom - top
    )
    return frame[top:bottom, left:right], local


def areas(windows: Bounds) -> Bins:
    """Pixels in each window, shape (N,)."""
    return np.asarray((windows.right - windows.left) * (windows.bottom - windows.top))


def bin_counts(indices: npt.NDArray[Any], active: Bins, bins: int, windows: Bounds) -> Counts:
    """Count the pixels of each active bin in each window.

    Parameters
    ----------
    indices : (H, W) array of integers
        Bin of each pixel, below `bins`.
    active : (K,) array
        The bins to count.
    bins : int
        Number of bins there are.
    windows : Bounds
        Rectangles in `indices`, arrays of shape (N,).

    Returns
    -------
    (N, K) array
        Exact counts.
    """
    if len(windows.left) == 1:  # is counted sooner than anything is integrated
        left, top, right, bottom = (int(side[0]) for side in windows)
        inside = indices[top:bottom, left:right].ravel()
        return np.asarray(np.bincount(inside, minlength=bins)[np.newaxis, active])
    # Integral images make the cost of a window independent of its size: four look-ups per plane.
    counts = np.zeros((len(windows.left), len(active)), dtype=np.int64)
    if indices.size == 0:
        return counts
    size = max(min(_MOST_PLANES, _MOST_VALUES // indices.size), 1)
    for start in range(0, len(active), size):
        part = active[start : start + size]
        counts[:, start : start + len(part)] = _count(indices, part, bins, windows)
    return counts


def _count(indices: npt.NDArray[Any], active: Bins, bins: int, windows: Bounds) -> Counts:
    # A lane with room for the whole region's count never carries into the next one.
    lane_bits = int(indices.size).bit_length()
    # Several bins share a float64, each in a lane of its bits: fewer planes to integrate.
    lanes = max(_EXACT_BITS // lane_bits, 1)
    lookup = _lanes_of_bins(active.tobytes(), bins, lane_bits, lanes)
    # Sums below 2 ** 53 are exact in a float64, so that lanes can be taken apart by their bits.
    sums = _window_sums(lookup.take(indices, axis=0), windows).astype(np.int64)
    shifts = lane_bits * np.arange(lanes)
    counts = (sums[..., np.newaxis] >> shifts) & ((1 << lane_bits) - 1)
    return np.asarray(counts.reshape(len(sums), -1)[:, : len(active)])


@functools.lru_cache(maxsize=8)
def _lanes_of_bins(active: bytes, bins: int, lane_bits: int, lanes: int) -> npt.NDArray[np.float64]:
    """Return the value that a pixel of each bin adds to each plane, shape (bins, planes).

    The table is the same for many frames. `active` are the bytes of the active bins' numbers.
    """
    chosen = np.frombuffer(active, dtype=np.intp)
    order = np.arange(len(chosen))
    lookup = np.zeros((bins, -(-len(chosen) // lanes)))
    lookup[chosen, order // lanes] = 2.0 ** (lane_bits * (order % lanes))
    return lookup


def _window_sums(planes: npt.NDArray[np.float64], windows: Bounds) -> npt.NDArray[np.float64]:
    """Sum of every plane over every window: shape (N, planes)."""
    _, width, count = planes.shape
    summed = np.asarray(cv2.integral(planes)).reshape(-1, count)
    left, top, right, bottom = windows
    # Flat indices, since `take` is faster than indexing by two arrays.
    upper = top * (width + 1)
    lower = bottom * (width + 1)
    corners = [summed.take(at, axis=0) for at in (lower + right, upper + right, lower + left)]
    return np.asarray(corners[0] - corners[1] - corners[2] + summed.take(upper + left, axis=0))
