# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mean shift of many windows (`image.windows.mean_shift`), in numba."""

from __future__ import annotations

import functools
import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.kernels.numba_types import (
    CELL_PLANES,
    REALS,
    RECTANGLES,
    Cells,
    Pixels,
    Reals,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined
from vehicle_pf_tracker.image.windows.mean_shift import epanechnikov
from vehicle_pf_tracker.image.windows.window import Window

Offsets: TypeAlias = npt.NDArray[np.int64]

_OFFSETS = "Array(int64, 2, 'C', readonly=True)"
"""x, y of the kernel's pixels from its centre, (P, 2); shared between frames."""
_ARGUMENTS = CELL_PLANES, RECTANGLES, _OFFSETS, REALS, REALS
"""Both kernels take the same: cells, centres, offsets, profile and values."""


# A choice: of each size of a window one; targets change theirs slowly.
@functools.lru_cache(maxsize=8)
def ellipse(window: Window) -> tuple[Offsets, Reals]:
    """Offsets x, y (P, 2) and profile (P,) of the kernel's pixels."""
    kernel = epanechnikov(window)
    offsets = kernel[0].astype(np.int64)
    profile = kernel[1].copy()
    offsets.flags.writeable = profile.flags.writeable = False
    return offsets, profile


@inlined
def _weigh_cells(
    cells: Cells, x: int, y: int, offsets: Offsets, profile: Reals, masses: Reals
) -> float:
    """Fill in the kernel mass of each cell, and return that of all pixels that exist."""
    height, width = cells.shape[1:]
    for k in range(len(masses)):
        masses[k] = 0.0
    total = 0.0
    for j in range(len(offsets)):
        column, row = x + offsets[j, 0], y + offsets[j, 1]
        # Pixels outside the frame have no mass: the norm is that of the ones that exist.
        if 0 <= column < width and 0 <= row < height:
            masses[cells[0, row, column]] += profile[j]
            total += profile[j]
    return total


@inlined
def _check(cells: Cells, pixels: Pixels, offsets: Offsets, profile: Reals, values: Reals) -> None:
    """Raise an error where a cell has no value, or an array is too short."""
    # Once per call: the loops below trust every index.
    largest = np.uint16(0)
    for plane in range(cells.shape[0]):
        for y in range(cells.shape[1]):
            for x in range(cells.shape[2]):
                largest = max(largest, cells[plane, y, x])
    if cells.size and largest >= len(values):
        raise IndexError("a cell is not among those of the reference")
    if len(cells) == 0 or pixels.shape[1] != 2 or offsets.shape[1] != 2:
        raise IndexError("there is no plane of cells, or no pair of coordinates")
    if len(profile) < len(offsets):
        raise IndexError("the profile is shorter than the ellipse")


@compiled("float64[::1]", *_ARGUMENTS)
def compare_kernels(
    cells: Cells, pixels: Pixels, offsets: Offsets, profile: Reals, values: Reals
) -> Reals:
    """Compare the kernel-weighted histograms of windows with a reference.

    Parameters
    ----------
    cells : (1, H, W) array
        Cells of the part that all windows cover, cut at the border of the frame.
    pixels : (N, 2) array
        Centre x, y of each window in it.
    offsets : (P, 2) array
        Pixels of the ellipse around a centre.
    profile : (P,) array
        Profile of those pixels.
    values : (K + 1 or more,) array
        Square roots of the reference at the active bins, then zeros.

    Returns
    -------
    (N,) array
        Bhattacharyya coefficients.
    """
    _check(cells, pixels, offsets, profile, values)
    # Made once, filled for each window.
    masses = np.empty(len(values))
    result = np.empty(len(pixels))
    for i in range(len(pixels)):
        # One window after the other: kernels overlap, but weigh the same pixel differently.
        x, y = pixels[i]
        total = _weigh_cells(cells, x, y, offsets, profile, masses)
        overlap = 0.0
        for k in range(len(values)):
            overlap += values[k] * math.sqrt(masses[k])
        # The total is not zero: the centre pixel always exists.
        result[i] = min(overlap / math.sqrt(total), 1.0)
    return result


@compiled("float64[:, ::1]", *_ARGUMENTS)
def shift_kernels(
    cells: Cells, pixels: Pixels, offsets: Offsets, profile: Reals, values: Reals
) -> Reals:
    """Step of each window from its centre x, y to the mean; parameters as for `compare_kernels`.

    Returns
    -------
    (N, 2) array
        Not a number where the ellipse has no colour of the reference.
    """
    _check(cells, pixels, offsets, profile, values)
    height, width = cells.shape[1:]
    masses = np.empty(len(values))
    weights = np.empty(len(values))
    steps = np.empty((len(pixels), 2))
    for i in range(len(pixels)):
        # Until it is known that the window has a colour of the reference.
        steps[i, 0] = steps[i, 1] = np.nan
        x, y = pixels[i]
        _weigh_cells(cells, x, y, offsets, profile, masses)
        for k in range(len(values)):
            # sqrt(q / p) of equation 25, once per colour instead of once per pixel.
            weights[k] = values[k] / math.sqrt(masses[k]) if masses[k] > 0 else 0.0
        across = down = total = 0.0
        for j in range(len(offsets)):
            column, row = x + offsets[j, 0], y + offsets[j, 1]
            if 0 <= column < width and 0 <= row < height:
                weight = weights[cells[0, row, column]]
                across += weight * offsets[j, 0]
                down += weight * offsets[j, 1]
                total += weight
        if total > 0:
            # Else not a number: the caller leaves such a window where it is.
            steps[i, 0] = across / total
            steps[i, 1] = down / total
    return steps
