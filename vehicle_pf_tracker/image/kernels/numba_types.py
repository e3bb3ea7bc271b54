# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Types of the arrays that compiled kernels take: for numba in capitals, for annotations beside it.

Layout "A" takes parts of frames without a copy; "C" lets numba's loops along the last axis be
vectorised. What is read only is marked so, since references are shared between frames.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

RGB_IMAGE = "Array(uint8, 3, 'A', readonly=True)"
"""Part of a frame, (H, W, 3)."""
GREY_IMAGE = "Array(uint8, 2, 'A', readonly=True)"
"""Grey levels of a part of a frame, (H, W)."""

Cells: TypeAlias = npt.NDArray[np.uint16]
CELL_PLANES = "uint16[:, :, ::1]"
"""Cell of each pixel, by planes, (P, H, W)."""
Table: TypeAlias = npt.NDArray[np.uint16]
BIN_TABLE = "Array(uint16, 1, 'C', readonly=True)"
"""Cell of each bin, (bins,)."""
Counts: TypeAlias = npt.NDArray[np.int32]
COUNTS = "int32[:, ::1]"
"""Pixels in each cell of each window, (N, K + 1 or more)."""
Columns: TypeAlias = npt.NDArray[np.uint16]
"""Pixels in each cell of each column of a part, (W, K + 1 or more)."""

Rectangles: TypeAlias = npt.NDArray[np.int64]
RECTANGLES = "int64[:, ::1]"
"""Integers by rows: x, y of pixels, (N, 2), or left, top, right, bottom of windows, (N, 4)."""
Pixels: TypeAlias = npt.NDArray[np.int64]
"""x, y of pixels, (N, 2)."""
POSITIONS = "Array(float64, 2, 'A', readonly=True)"
"""x, y in continuous px, (N, 2)."""
PAIR = "UniTuple(int64, 2)"
"""Two numbers of px, along x and y."""
Extent: TypeAlias = tuple[int, int, int, int]
EXTENT = "UniTuple(int64, 4)"
"""Left, top, right and bottom, px."""
Reach: TypeAlias = tuple[int, int, int]
REACH = "UniTuple(int64, 3)"
"""Pixels of a window to the left of its middle, from the middle to the right, and above it."""

Reals: TypeAlias = npt.NDArray[np.float64]
REALS = "Array(float64, 1, 'C', readonly=True)"
"""Numbers, (N,)."""
Scale: TypeAlias = tuple[Reals, Reals]
SCALE = f"UniTuple({REALS}, 2)"
"""Square roots of the reference at the active bins, then zeros, and those of 0, 1, 2, …"""
