# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Part of a frame that windows cover, and their middles in it, in numba."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.image.kernels.numba_types import (
    EXTENT,
    PAIR,
    POSITIONS,
    RECTANGLES,
    Extent,
    Pixels,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined
from vehicle_pf_tracker.image.windows.window import Positions


@inlined
def extent_of(pixels: Pixels) -> Extent:
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
    x0, y0, x1, y1 = extent_of(pixels)
    left, top = max(x0 - beside - margin, 0), max(y0 - above - margin, 0)
    right, bottom = min(x1 + beside + 1 + margin, width), min(y1 + above + 1 + margin, height)
    for i in range(len(pixels)):
        pixels[i, 0] -= left
        pixels[i, 1] -= top
    return pixels, (left, top, right, bottom)
