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

"""Windows and references in the form that the compiled kernels take."""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
from numba import types

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.kernels.numba_jit import Table, compiled
from vehicle_pf_tracker.image.kernels.numba_windows import (
    Pixels,
    Reach,
    Reals,
    window_pixels,
)
from vehicle_pf_tracker.image.similarity import Histogram, Reference
from vehicle_pf_tracker.image.textures import Cooccurrence
from vehicle_pf_tracker.image.window import Positions, Window, WindowFeature


class Placement(NamedTuple):
    """Positions of windows in a frame.

    Attributes
    ----------
    pixels : (N, 2) array
        Centre x, y of each window.
    extent : (int, int, int, int)
        Least x and y, largest x and y of them.
    reach : (int, int, int)
        Pixels of a window left of its centre, right of it counting itself, and above it.
    size : (int, int)
        Width and height of the frame.
    """

    pixels: Pixels
    extent: tuple[int, int, int, int]
    reach: Reach
    size: tuple[int, int]

    @classmethod
    def of(
        cls, feature: WindowFeature, frame: Frame, positions: Positions, window: Window
    ) -> Placement:
        """Find the windows around positions."""
        size = frame_size(frame)
        pixels, extent = window_pixels(positions, *size)
        return cls(pixels, extent, reach_of(feature, window), size)

    def covered(self, margin: int = 0) -> tuple[int, int, int, int]:
        """Left, top, right, bottom of all windows, and of a margin as far as the frame goes."""
        (x0, y0, x1, y1), (left, _, up) = self.extent, self.reach
        width, height = self.size
        return (
            max(x0 - left - margin, 0),
            max(y0 - up - margin, 0),
            min(x1 + left + 1 + margin, width),
            min(y1 + up + 1 + margin, height),
        )


def reach_of(feature: WindowFeature, window: Window) -> Reach:
    """Reach of a feature's windows; pairs of pixels end one column earlier."""
    right = window.half_width + (0 if type(feature) is Cooccurrence else 1)
    return window.half_width, right, window.half_height


_LANES = 16
"""Cells are padded to a multiple of this, so that loops over them fill vector registers."""

_MOST_ROOTS = 1 << 16
"""Largest table of square roots: 512 KB, which fits the second-level cache of common processors."""

_HISTOGRAM = types.Array(types.float64, 1, "A", readonly=True)


class CellTable(NamedTuple):
    """Cell of each bin, and the factor of each cell's count.

    Attributes
    ----------
    cells : (bins,) array of uint16
        Position of each active bin among the K active ones, K for all others.
    active : int
        K.
    values : (K + 1 or more,) array
        Square roots of the reference at the active bins, followed by zeros.
    """

    cells: Table
    active: int
    values: Reals


@compiled(types.Tuple((types.uint16[::1], types.int64, types.float64[::1]))(_HISTOGRAM))
def _number_cells(histogram: Histogram) -> tuple[Table, int, Reals]:
    """Give a number to each bin that is not zero; see `CellTable` for what is returned."""
    active = 0
    for value in histogram:
        active += value != 0
    cells = np.full(len(histogram), active, np.uint16)
    values = np.zeros(-(-(active + 1) // _LANES) * _LANES)
    number = 0
    for k in range(len(histogram)):
        if histogram[k] != 0:
            cells[k], values[number] = number, math.sqrt(histogram[k])
            number += 1
    return cells, active, values


def table_of(reference: Reference) -> CellTable:
    """Return the table of a reference, computed once."""
    kept = reference.kept.get("cells")
    if not isinstance(kept, CellTable):
        kept = CellTable(*_number_cells(reference.histogram))
        reference.kept["cells"] = kept
    return kept


def roots_up_to(count: int) -> Reals:
    """Square roots of 0 to `count` or more, as far as a table of them is worth while."""
    return _roots(min(1 << int(count).bit_length(), _MOST_ROOTS))


@functools.lru_cache(maxsize=32)
def _roots(length: int) -> Reals:
    table = np.sqrt(np.arange(length + 1, dtype=np.float64))
    table.flags.writeable = False
    return table
