# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cells of oriented gradients, compiled; `image.correlation.gradient_cells` says what they are."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.correlation.gradient_cells import (
    DIRECTIONS,
    GRADIENT_CELL_PX,
    GRADIENT_CHANNELS,
    NOISE_ENERGY,
    TEXTURE_GAIN,
    TRUNCATION,
    CellFeatures,
    Grey,
    direction_of,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled, inlined

_UNSIGNED = DIRECTIONS // 2
"""Directions of gradients whose sign does not count."""
_IMAGE = "uint8[:, ::1]"
"""Luminance of a patch, (H, W)."""
_BYTES = "Array(uint8, 1, 'C', readonly=True)"
"""The table of directions, flat."""
_CELLS = "float32[:, :, ::1]"
"""Channels of cells as they are written, (r, channels, c)."""


@inlined
def _gradients(
    grey: Grey, y: int, magnitudes: npt.NDArray[np.float32], places: npt.NDArray[np.uint32]
) -> None:
    """Write magnitudes of a row, and places in the table of directions; vectorised."""
    for x in range(1, grey.shape[1] - 1):
        dx = np.int32(grey[y, x + 1]) - np.int32(grey[y, x - 1])
        dy = np.int32(grey[y + 1, x]) - np.int32(grey[y - 1, x])
        magnitudes[x] = np.sqrt(np.float32(dx * dx + dy * dy))
        places[x] = np.uint32((dy + 255) * 511 + dx + 255)


@inlined
def _share_row(
    sums: npt.NDArray[np.float32],
    low: float,
    above: npt.NDArray[np.float32],
    below: npt.NDArray[np.float32],
) -> None:
    """Share a row's sums between the cells above and below, and clear them."""
    for i in range(len(sums)):
        lower = low * sums[i]
        above[i] += sums[i] - lower
        below[i] += lower
        sums[i] = 0


@inlined
def _direction_histograms(
    grey: Grey, direction_of: npt.NDArray[np.uint8]
) -> npt.NDArray[np.float32]:
    """Sum magnitudes by direction and cell, one cell more on each side, (18, r + 2, c + 2).

    Only the sums of each row of pixels are scattered; indices are unsigned, as signed ones would be
    tested for being negative.
    """
    height, width = grey.shape
    columns = width // GRADIENT_CELL_PX + 2
    cells = np.zeros((DIRECTIONS, height // GRADIENT_CELL_PX + 2, columns), np.float32)
    # 1. Buffers: a row of cells at a time stays in the first cache; whole images would not.
    sums = np.zeros(DIRECTIONS * columns, np.float32)
    above = np.zeros_like(sums)
    below = np.zeros_like(sums)
    magnitudes = np.empty(width, np.float32)
    places = np.empty(width, np.uint32)
    column = np.empty(width, np.uint64)
    share = np.empty(width, np.float32)
    for x in range(width):
        # The middle of a pixel in units of cells; half a cell further, as the first is the
        # border's.
        place_x = (x + 0.5) / GRADIENT_CELL_PX + 0.5
        column[x] = np.uint64(place_x)
        share[x] = np.float32(place_x - np.floor(place_x))
    # 2. Outermost pixels have no central difference, and take no part.
    for y in range(1, height - 1):
        _gradients(grey, y, magnitudes, places)
        for x in range(1, width - 1):
            # Bilinear shares: along x here, along y once per row of pixels.
            right = share[x] * magnitudes[x]
            # Whatever the table says, no sum behind the last one is written.
            direction = min(direction_of[places[x]], np.uint8(DIRECTIONS - 1))
            i = np.uint64(direction) * np.uint64(columns) + column[x]
            sums[i] += magnitudes[x] - right
            sums[i + np.uint64(1)] += right
        place_y = (y + 0.5) / GRADIENT_CELL_PX + 0.5
        row = int(place_y)
        _share_row(sums, np.float32(place_y - row), above, below)
        # 3. The next row of pixels belongs to other cells: what was gathered is written.
        if int((y + 1.5) / GRADIENT_CELL_PX + 0.5) != row or y == height - 2:
            # Channel by channel: the innermost loop runs along memory.
            for o in range(DIRECTIONS):
                for x in range(columns):
                    cells[o, row, x] += above[o * columns + x]
                    cells[o, row + 1, x] += below[o * columns + x]
                    above[o * columns + x] = 0
                    below[o * columns + x] = 0
    return cells


@inlined
def _repeat_border(energy: npt.NDArray[np.float32]) -> None:
    """Repeat the outermost inner cells of energies (r + 2, c + 2) beyond the border."""
    rows = energy.shape[0] - 2
    columns = energy.shape[1] - 2
    for y in range(1, rows + 1):
        energy[y, 0] = energy[y, 1]
        energy[y, columns + 1] = energy[y, columns]
    for x in range(columns + 2):
        energy[0, x] = energy[1, x]
        energy[rows + 1, x] = energy[rows, x]


@inlined
def _scales(cells: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Inverse norms of the four neighbourhoods of the inner cells, (4, r, c)."""
    rows = cells.shape[1] - 2
    columns = cells.shape[2] - 2
    # Of unsigned directions: the sign of an edge does not make it stronger.
    energy = np.zeros((rows + 2, columns + 2), np.float32)
    for y in range(1, rows + 1):
        for o in range(_UNSIGNED):
            for x in range(1, columns + 1):
                value = cells[o, y, x] + cells[o + _UNSIGNED, y, x]
                energy[y, x] += value * value
    # Blocks at the border would else be half empty, and their cells too bright.
    _repeat_border(energy)
    scales = np.empty((4, rows, columns), np.float32)
    for k in range(4):
        for y in range(rows):
            top = y + k // 2
            left = k % 2
            for x in range(columns):
                # Each cell has four blocks of 2 x 2 cells that contain it.
                block = energy[top, left + x] + energy[top, left + x + 1]
                block += energy[top + 1, left + x] + energy[top + 1, left + x + 1]
                scales[k, y, x] = np.float32(1) / np.sqrt(block + np.float32(NOISE_ENERGY))
    return scales


@inlined
def _clear(sums: npt.NDArray[np.float32]) -> None:
    for k in range(sums.shape[0]):
        for x in range(sums.shape[1]):
            sums[k, x] = 0


@inlined
def _normalise(
    cells: npt.NDArray[np.float32], scales: npt.NDArray[np.float32], features: CellFeatures
) -> None:
    """Write the channels of the inner cells; the inner loops, along x, are vectorised."""
    rows = features.shape[0]
    columns = features.shape[2]
    # As float32: a float64 would widen, and halve the lanes of, the loops below.
    limit = np.float32(TRUNCATION)
    half = np.float32(0.5)
    texture = np.empty((4, columns), np.float32)
    for y in range(rows):
        # 1. Signed directions. By rows: what is summed over directions stays in the first cache.
        _clear(texture)
        for o in range(DIRECTIONS):
            for x in range(columns):
                # Summed in the order of the version in numpy, which it has to agree with to 1e-6.
                value = cells[o, y + 1, x + 1]
                a = min(value * scales[0, y, x], limit)
                b = min(value * scales[1, y, x], limit)
                c = min(value * scales[2, y, x], limit)
                d = min(value * scales[3, y, x], limit)
                features[y, o, x] = half * (((a + b) + c) + d)
                texture[0, x] += a
                texture[1, x] += b
                texture[2, x] += c
                texture[3, x] += d
        for o in range(_UNSIGNED):
            for x in range(columns):
                # 2. Unsigned: the same edge before a bright and a dark road.
                value = cells[o, y + 1, x + 1] + cells[o + _UNSIGNED, y + 1, x + 1]
                a = min(value * scales[0, y, x], limit)
                b = min(value * scales[1, y, x], limit)
                c = min(value * scales[2, y, x], limit)
                d = min(value * scales[3, y, x], limit)
                features[y, DIRECTIONS + o, x] = half * (((a + b) + c) + d)
        # 3. Texture: the energy of all signed directions by neighbourhood.
        for k in range(4):
            for x in range(columns):
                features[y, DIRECTIONS + _UNSIGNED + k, x] = (
                    np.float32(TEXTURE_GAIN) * texture[k, x]
                )


@compiled(_CELLS, _IMAGE, _BYTES, "intp")
def _features(grey: Grey, direction_of: npt.NDArray[np.uint8], channels: int) -> CellFeatures:
    # Numba does not check indices; a short table would be read beyond its end.
    if len(direction_of) < 511 * 511:
        raise IndexError("the table of directions is too short")
    if channels < DIRECTIONS + _UNSIGNED + 4:
        raise IndexError("there are fewer channels than features")
    # In this order of memory rows are transformed without a copy.
    features = np.empty(
        (grey.shape[0] // GRADIENT_CELL_PX, channels, grey.shape[1] // GRADIENT_CELL_PX), np.float32
    )
    cells = _direction_histograms(grey, direction_of)
    _normalise(cells, _scales(cells), features)
    return features


def gradient_cells(grey: Grey, spare: int = 0) -> CellFeatures:
    """See `gradient_cells.gradient_cells`; `grey` is contiguous."""
    features = _features(grey, direction_of().ravel(), GRADIENT_CHANNELS + spare)
    return np.asarray(features.transpose(1, 0, 2))
