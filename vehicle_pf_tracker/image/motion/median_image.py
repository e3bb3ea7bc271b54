# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Median of images, pixel by pixel: what stands in most of them."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt


def median(images: list[npt.NDArray[np.uint8]]) -> npt.NDArray[np.uint8]:
    """Upper median, pixel by pixel.

    Sorted by exchanges of whole images, which takes a small part of the time of sorting the values
    of each pixel.
    """
    images = images.copy()
    for low, high, is_low_used, is_high_used in _exchanges(len(images)):
        pair = images[low], images[high]
        if is_low_used:
            images[low] = np.minimum(*pair)
        if is_high_used:
            images[high] = np.maximum(*pair)
    return np.ascontiguousarray(images[len(images) // 2])


@functools.cache
def _exchanges(count: int) -> Sequence[tuple[int, int, bool, bool]]:
    """List the exchanges of a sort that the upper median of `count` values depends on.

    Each is two places, and whether the lower and the higher of their values are used.
    """
    # From the last to the first: whatever a used value is chosen from is used, too.
    used = {count // 2}
    needed = []
    for low, high in reversed(list(_sorted_by(0, 1 << (count - 1).bit_length()))):
        # Beyond the last place are none; they would be the highest.
        if high < count and (low in used or high in used):
            needed.append((low, high, low in used, high in used))
            used |= {low, high}
    return needed[::-1]


def _sorted_by(first: int, count: int) -> Iterator[tuple[int, int]]:
    """Sort `count` values, a power of two: the odd-even merge sort of Batcher (1968)."""
    half = count // 2
    if half:
        yield from _sorted_by(first, half)
        yield from _sorted_by(first + half, half)
        yield from _merged_by(first, count, 1)


def _merged_by(first: int, count: int, apart: int) -> Iterator[tuple[int, int]]:
    """Merge the sorted halves of every value that is `apart` from the one before."""
    if 2 * apart == count:
        yield first, first + apart
        return
    yield from _merged_by(first, count, 2 * apart)
    yield from _merged_by(first + apart, count, 2 * apart)
    for low in range(first + apart, first + count - apart, 2 * apart):
        yield low, low + apart
