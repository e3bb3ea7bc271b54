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

"""Active bin of each pixel, in numba.

Cells are numbers from 0 to K, where K stands for all bins that are not active. They form planes,
shape (P, H, W): a window's counts are those of all planes together.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.kernels.numba_jit import compiled
from vehicle_pf_tracker.image.window_feature import Grey

Cells: TypeAlias = npt.NDArray[np.uint16]
Table: TypeAlias = npt.NDArray[np.uint16]
Rectangles: TypeAlias = npt.NDArray[np.int64]

FRAME = types.Array(types.uint8, 3, "A", readonly=True)
GREY = types.Array(types.uint8, 2, "A", readonly=True)
TABLE = types.Array(types.uint16, 1, "C", readonly=True)
CELLS = types.uint16[:, :, ::1]
RECTANGLES = types.int64[:, ::1]


@compiled(CELLS(FRAME, types.int64, TABLE))
def marginal_cells(pixels: Frame, levels: int, table: Table) -> Cells:
    """Cells of each channel's own bins, a plane each; channel `c` has bins from ``c * levels``."""
    height, width, _ = pixels.shape
    cells = np.empty((3, height, width), np.uint16)
    for y in range(height):
        for x in range(width):
            for channel in range(3):
                level = (pixels[y, x, channel] * levels) >> 8
                cells[channel, y, x] = table[channel * levels + level]
    return cells


@compiled(CELLS(GREY, TABLE))
def pair_cells(grey: Grey, table: Table) -> Cells:
    """Cells of the 8 x 8 grey levels of each pixel and the next one in its row, one plane."""
    height, width = grey.shape[0], max(grey.shape[1] - 1, 0)
    cells = np.empty((1, height, width), np.uint16)
    for y in range(height):
        for x in range(width):
            cells[0, y, x] = table[((grey[y, x] >> 5) << 3) | (grey[y, x + 1] >> 5)]
    return cells


@compiled(types.uint8[:, :, ::1](FRAME, RECTANGLES, types.int64, types.int64))
def stack_windows(frame: Frame, rectangles: Rectangles, width: int, height: int) -> Frame:
    """Copy windows of at most `width` x `height` px one below the other, each to the left."""
    count = len(rectangles)
    stack = np.zeros((count * height, width, 3), np.uint8)
    for i in range(count):
        left, top, right, bottom = rectangles[i]
        for y in range(top, bottom):
            for x in range(left, right):
                for channel in range(3):
                    stack[i * height + y - top, x - left, channel] = frame[y, x, channel]
    return stack
