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

"""Cells of oriented gradients, compiled; see `image.gradient_cells` for what they are."""

from __future__ import annotations

import numba
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.gradient_cells import (
    CELL,
    DIRECTION_OF,
    DIRECTIONS,
    GRADIENT_CHANNELS,
    MAGNITUDE_OF,
    NOISE_ENERGY,
    TEXTURE_GAIN,
    TRUNCATION,
    CellFeatures,
    Grey,
)
from vehicle_pf_tracker.image.kernels.numba_jit import compiled

_HALF = DIRECTIONS // 2
_IMAGE = numba.types.Array(numba.uint8, 2, "C")
_BYTES = numba.types.Array(numba.uint8, 2, "C", readonly=True)
_FLOATS = numba.types.Array(numba.float32, 2, "C", readonly=True)

DIRECTION_OF.flags.writeable = False
MAGNITUDE_OF.flags.writeable = False


@compiled(numba.types.Array(numba.float32, 3, "C")(_IMAGE, _BYTES, _FLOATS))
def _direction_histograms(
    grey: Grey, direction_of: npt.NDArray[np.uint8], magnitude_of: npt.NDArray[np.float32]
) -> npt.NDArray[np.float32]:
    """Sum magnitudes by cell and direction, one cell more on each side, (r + 2, c + 2, 18)."""
    height, width = grey.shape
    cells = np.zeros((height // CELL + 2, width // CELL + 2, DIRECTIONS), np.float32)
    for y in range(1, height - 1):
        place_y = (y + 0.5) / CELL + 0.5
        row = int(place_y)
        low = np.float32(place_y - row)
        for x in range(1, width - 1):
            dx = np.int32(grey[y, x + 1]) - np.int32(grey[y, x - 1]) + 255
            dy = np.int32(grey[y + 1, x]) - np.int32(grey[y - 1, x]) + 255
            magnitude, o = magnitude_of[dy, dx], direction_of[dy, dx]
            place_x = (x + 0.5) / CELL + 0.5
            column = int(place_x)
            right = np.float32(place_x - column)
            upper, lower = (1 - low) * magnitude, low * magnitude
            cells[row, column, o] += (1 - right) * upper
            cells[row, column + 1, o] += right * upper
            cells[row + 1, column, o] += (1 - right) * lower
            cells[row + 1, column + 1, o] += right * lower
    return cells


@compiled(
    numba.void(numba.types.Array(numba.float32, 3, "C"), numba.types.Array(numba.float32, 3, "C"))
)
def _normalise(  # noqa: C901 - loops over cells, directions and neighbourhoods, compiled as one
    cells: npt.NDArray[np.float32], features: CellFeatures
) -> None:
    """Write the channels of the inner cells."""
    rows, columns = features.shape[1], features.shape[2]
    energy = np.zeros((rows + 2, columns + 2), np.float32)
    for y in range(rows + 2):
        for x in range(columns + 2):
            # Beyond the border the outermost cell is repeated.
            from_y, from_x = min(max(y, 1), rows), min(max(x, 1), columns)
            for o in range(_HALF):
                value = cells[from_y, from_x, o] + cells[from_y, from_x, o + _HALF]
                energy[y, x] += value * value
    scale, texture = np.empty(4, np.float32), np.empty(4, np.float32)
    limit = np.float32(TRUNCATION)
    for y in range(rows):
        for x in range(columns):
            for k in range(4):
                top, left = y + k // 2, x + k % 2
                block = energy[top, left] + energy[top, left + 1]
                block += energy[top + 1, left] + energy[top + 1, left + 1]
                scale[k] = np.float32(1) / np.sqrt(block + np.float32(NOISE_ENERGY))
                texture[k] = 0
            for o in range(DIRECTIONS):
                total = np.float32(0)
                for k in range(4):
                    cut = min(cells[y + 1, x + 1, o] * scale[k], limit)
                    total += cut
                    texture[k] += cut
                features[o, y, x] = np.float32(0.5) * total
            for o in range(_HALF):
                value = cells[y + 1, x + 1, o] + cells[y + 1, x + 1, o + _HALF]
                total = np.float32(0)
                for k in range(4):
                    total += min(value * scale[k], limit)
                features[DIRECTIONS + o, y, x] = np.float32(0.5) * total
            for k in range(4):
                features[DIRECTIONS + _HALF + k, y, x] = np.float32(TEXTURE_GAIN) * texture[k]


def gradient_cells(grey: Grey) -> CellFeatures:
    """Compute the channels of every whole cell, (31, r, c); `grey` is contiguous."""
    rows, columns = grey.shape[0] // CELL, grey.shape[1] // CELL
    features = np.empty((GRADIENT_CHANNELS, rows, columns), np.float32)
    _normalise(_direction_histograms(grey, DIRECTION_OF, MAGNITUDE_OF), features)
    return features
