# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Gradient of an image in whole numbers, in numba."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled
from vehicle_pf_tracker.image.windows.window import Grey

Slopes: TypeAlias = npt.NDArray[np.int16]
Strengths: TypeAlias = npt.NDArray[np.int32]
Images: TypeAlias = tuple[Slopes, Slopes, Strengths]

IMAGES = "Tuple((int16[:, ::1], int16[:, ::1], int32[:, ::1]))"
"""Gradients along x and y, and squared magnitudes."""


@compiled(IMAGES, "uint8[:, ::1]")
def gradients(grey: Grey) -> Images:
    """Gradient and squared magnitude (H, W), the image mirrored at its border as OpenCV does it.

    One pass over three rows at a time, which stay in the first cache, instead of OpenCV's two over
    all.
    """
    height, width = grey.shape
    gx = np.empty((height, width), np.int16)
    gy = np.empty((height, width), np.int16)
    strengths = np.empty((height, width), np.int32)
    smooth = np.empty(width + 2, np.int16)
    slope = np.empty(width + 2, np.int16)
    for y in range(height):
        # Mirrored about the outermost row; of a single row that is itself.
        above = y - 1 if y > 0 else min(1, height - 1)
        below = y + 1 if y < height - 1 else max(height - 2, 0)
        for x in range(width):
            over = grey[above, x]
            here = grey[y, x]
            under = grey[below, x]
            # Sobel's kernel is separable: smoothed and differenced down here, the other way along
            # x below. The largest gradient, 4 * 255, fits 16 bits.
            smooth[x + 1] = np.int16(over) + np.int16(2) * np.int16(here) + np.int16(under)
            slope[x + 1] = np.int16(under) - np.int16(over)
        for row in (smooth, slope):
            row[0], row[width + 1] = row[1 + min(1, width - 1)], row[1 + max(width - 2, 0)]
        for x in range(width):
            # An unsigned index needs no test for counting from the end.
            column = np.uint64(x)
            along = smooth[column + np.uint64(2)] - smooth[column]
            down = slope[column] + 2 * slope[column + np.uint64(1)] + slope[column + np.uint64(2)]
            # Squares of up to 2 * 1020² need 32 bits.
            gx[y, x], gy[y, x] = along, down
            strengths[y, x] = np.int32(along) * np.int32(along) + np.int32(down) * np.int32(down)
    return gx, gy, strengths
