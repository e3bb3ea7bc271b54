# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Active bin of each pixel, in numba.

Cells are numbers from 0 to K, where K stands for all bins that are not active. They form planes,
shape (P, H, W): a window's counts are those of all planes together.
"""

from __future__ import annotations

import math

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.kernels.numba_types import (
    BIN_TABLE,
    CELL_PLANES,
    GREY_IMAGE,
    RGB_IMAGE,
    Cells,
    Table,
)
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled
from vehicle_pf_tracker.image.windows.similarity import Histogram
from vehicle_pf_tracker.image.windows.window import Grey


@compiled(CELL_PLANES, RGB_IMAGE, "int64", BIN_TABLE)
def joint_cells(pixels: Frame, bits: int, table: Table) -> Cells:
    """Cells of joint RGB bins, one plane."""
    height, width, channels = pixels.shape
    if channels != 3 or not 1 <= bits <= 8 or len(table) < 1 << (3 * bits):
        raise IndexError("the reference has fewer bins than the feature")
    cells = np.empty((1, height, width), np.uint16)
    drop = 8 - bits
    for y in range(height):
        for x in range(width):
            red = pixels[y, x, 0]
            green = pixels[y, x, 1]
            blue = pixels[y, x, 2]
            number = ((red >> drop) << (2 * bits)) | ((green >> drop) << bits) | (blue >> drop)
            cells[0, y, x] = table[number]
    return cells


@compiled("float64[::1]", RGB_IMAGE, "int64")
def joint_shares(pixels: Frame, bits: int) -> Histogram:
    """Share of each joint RGB bin, all zero where there is no pixel.

    In one pass: to count the cells of all pixels with numpy took twice as long.
    """
    height, width, channels = pixels.shape
    if channels != 3 or not 1 <= bits <= 5:
        raise IndexError("the image has other channels, or the feature other bits")
    shares = np.empty(1 << (3 * bits))
    for k in range(len(shares)):
        shares[k] = 0.0
    drop = 8 - bits
    for y in range(height):
        for x in range(width):
            red = pixels[y, x, 0]
            green = pixels[y, x, 1]
            blue = pixels[y, x, 2]
            number = ((red >> drop) << (2 * bits)) | ((green >> drop) << bits) | (blue >> drop)
            shares[number] += 1
    # Whole numbers until here, so that the shares have the bits of any other count.
    total = max(height * width, 1)
    for k in range(len(shares)):
        shares[k] /= total
    return shares


@compiled(CELL_PLANES, RGB_IMAGE, "int64", BIN_TABLE)
def marginal_cells(pixels: Frame, levels: int, table: Table) -> Cells:
    """Cells of each channel's own bins, a plane each; channel `c` has bins from ``c * levels``."""
    height, width, channels = pixels.shape
    if channels != 3 or not 0 <= 3 * levels <= len(table):
        raise IndexError("the reference has fewer bins than the feature")
    cells = np.empty((3, height, width), np.uint16)
    for y in range(height):
        for x in range(width):
            for channel in range(3):
                # floor(v * levels / 256) in integers, as `colour.marginal_bins` has it.
                level = (pixels[y, x, channel] * levels) >> 8
                cells[channel, y, x] = table[channel * levels + level]
    return cells


@compiled(CELL_PLANES, GREY_IMAGE, BIN_TABLE)
def pair_cells(grey: Grey, table: Table) -> Cells:
    """Cells of the 8 x 8 grey levels of each pixel and the next one in its row, one plane."""
    height = grey.shape[0]
    width = max(grey.shape[1] - 1, 0)
    # Checked once per call: numba reads behind the end of an array without a word.
    if len(table) < 64:
        raise IndexError("the reference has fewer bins than the feature")
    cells = np.empty((1, height, width), np.uint16)
    for y in range(height):
        for x in range(width):
            # As `textures.pair_bins`: three bits of each of two neighbours.
            cells[0, y, x] = table[((grey[y, x] >> 5) << 3) | (grey[y, x + 1] >> 5)]
    return cells


@compiled("Tuple((uint16[::1], float64[::1]))", "Array(float64, 1, 'A', readonly=True)", "int64")
def number_cells(histogram: Histogram, lanes: int) -> tuple[Table, Histogram]:
    """Give a number to each bin that is not zero: cell of each bin, and roots of the cells' values.

    All other bins have the number after the last; the values are padded with zeros to a multiple of
    `lanes`. A reference that follows the vehicle is numbered in each frame, which numpy does in
    half a dozen calls.
    """
    # 32768 bins are five bits a channel, the most that `colour` takes, and cells are 16 bits wide.
    if len(histogram) > 1 << 15 or lanes < 1:
        raise IndexError("there are more bins than cells can number")
    active = 0
    for value in histogram:
        # Counted first: other bins get the number after the last active one.
        active += value != 0
    cells = np.empty(len(histogram), np.uint16)
    # Rounded up, so that the loop over cells has no remainder; zeros add nothing.
    values = np.empty(-(-(active + 1) // lanes) * lanes)
    for k in range(active, len(values)):
        values[k] = 0.0
    number = 0
    for k in range(len(histogram)):
        cells[k] = active
        if histogram[k] != 0:
            cells[k] = number
            values[number] = math.sqrt(histogram[k])
            number += 1
    return cells, values
