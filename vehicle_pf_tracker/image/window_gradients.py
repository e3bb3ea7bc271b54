"""Edge directions with the gradient taken in each window by itself, as P2 prints it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.sobel import (
    DIRECTION_BINS,
    Strengths,
    direction_bins,
    squared_strength,
)
from vehicle_pf_tracker.image.window import Bounds
from vehicle_pf_tracker.image.window_feature import Grey

Indices: TypeAlias = npt.NDArray[np.intp]
LimitsOf: TypeAlias = Callable[[Strengths], Strengths]

_CHUNK = 1_000_000
"""Pixels of windows that are looked at together; bounds the memory."""


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
