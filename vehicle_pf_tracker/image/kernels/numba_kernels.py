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

"""The kernels in numba, and windows and references in the form that they take."""

from __future__ import annotations

import functools
import math
from typing import NamedTuple, TypeGuard

import numpy as np
from numba import types

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.colour import CHANNEL_BINS, JointColour, RgbMarginals
from vehicle_pf_tracker.image.gradients import GradientDirections, gradients_of
from vehicle_pf_tracker.image.kernels import numba_correlation, numba_jit
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.kernels.numba_edges import TANGENTS, count_edges
from vehicle_pf_tracker.image.kernels.numba_jit import (
    Cells,
    Table,
    compiled,
    marginal_cells,
    pair_cells,
)
from vehicle_pf_tracker.image.kernels.numba_mean_shift import (
    Ellipse,
    Offsets,
    compare_kernels,
    ellipse,
    shift_kernels,
)
from vehicle_pf_tracker.image.kernels.numba_windows import (
    Pixels,
    Reach,
    Reals,
    compare_counts,
    compare_joint,
    compare_windows,
    joint_cells,
    window_pixels,
)
from vehicle_pf_tracker.image.similarity import Histogram, Reference
from vehicle_pf_tracker.image.textures import Cooccurrence
from vehicle_pf_tracker.image.window import Coefficients, Positions, Window, WindowFeature, to_grey


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
        """Left, top, right, bottom of all windows and a margin, as far as the frame goes."""
        (x0, y0, x1, y1), (left, _, up), (width, height) = self.extent, self.reach, self.size
        right, bottom = min(x1 + left + 1 + margin, width), min(y1 + up + 1 + margin, height)
        return max(x0 - left - margin, 0), max(y0 - up - margin, 0), right, bottom


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


_COUNTED_PIXELS = {JointColour, RgbMarginals, Cooccurrence}
"""Features of which each pixel counts equally in all windows."""


def kernel_similarity(
    frame: Frame, positions: Positions, window: Window, reference: Reference, bits: int
) -> Coefficients:
    """Compare kernel-weighted histograms; see `image.mean_shift`."""
    return compare_kernels(*_ellipses(frame, positions, window, reference, bits))


def mean_shift(
    frame: Frame, positions: Positions, window: Window, reference: Reference, bits: int
) -> Positions:
    """Move every position one mean-shift step; see `image.mean_shift`."""
    arguments = _ellipses(frame, positions, window, reference, bits)
    steps = shift_kernels(*arguments)
    return np.where(np.isnan(steps), positions, arguments[1] + 0.5 + steps)


def _ellipses(
    frame: Frame, positions: Positions, window: Window, reference: Reference, bits: int
) -> tuple[Cells, Pixels, tuple[int, int], Offsets, Ellipse]:
    """Return the arguments of `compare_kernels`."""
    placement = Placement.of(JointColour(bits), frame, positions, window)
    table = table_of(reference)
    left, top, right, bottom = placement.covered()
    cells = joint_cells(frame[top:bottom, left:right], bits, table.cells)
    offsets, profile = ellipse(window)
    return cells, placement.pixels, (left, top), offsets, (profile, table.values)


class NumbaKernels(Kernels):
    """Compiled kernels; importing this module compiles them, or loads what was compiled before."""

    name = "numba"

    gradient_cells = staticmethod(numba_correlation.gradient_cells)
    correlated = staticmethod(numba_correlation.correlated)
    kernel_similarity = staticmethod(kernel_similarity)
    mean_shift = staticmethod(mean_shift)

    def __init__(self) -> None:
        super().__init__(numba_jit.notices())

    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows; see `Kernels.similarity`."""
        if type(feature) in _COUNTED_PIXELS:
            table = table_of(reference)
            return _compare_pixels(feature, frame, positions, window, table)
        if _counts_edges(feature):
            return _compare_edges(feature, frame, positions, window, table_of(reference))
        return super().similarity(feature, frame, positions, window, reference)


def _counts_edges(feature: WindowFeature) -> TypeGuard[GradientDirections]:
    """Test whether edge points of the frame's gradient are counted."""
    return type(feature) is GradientDirections and feature.in_frame


def _compare_pixels(
    feature: WindowFeature, frame: Frame, positions: Positions, window: Window, table: CellTable
) -> Reals:
    """Compare windows by their pixels."""
    planes = 3 if type(feature) is RgbMarginals else 1
    scale = table.values, roots_up_to(planes * window.width * window.height)
    if isinstance(feature, JointColour):
        half = window.half_width, window.half_height
        return compare_joint(frame, positions, feature.bits, half, table.cells, scale)
    placement = Placement.of(feature, frame, positions, window)
    left, top, right, bottom = placement.covered()
    region = frame[top:bottom, left:right]
    if isinstance(feature, RgbMarginals):
        cells = marginal_cells(region, CHANNEL_BINS, table.cells)
    else:
        cells = pair_cells(to_grey(region), table.cells)
    return compare_windows(
        cells, placement.pixels, placement.extent, (left, top), placement.reach, scale
    )


def _compare_edges(
    feature: GradientDirections,
    frame: Frame,
    positions: Positions,
    window: Window,
    table: CellTable,
) -> Reals:
    """Compare windows by the directions of their edge points, the gradient taken in the frame."""
    placement = Placement.of(feature, frame, positions, window)
    # One pixel more makes every gradient in the windows that of the whole frame.
    left, top, right, bottom = placement.covered(margin=1)
    counts = np.empty((len(positions), len(table.values)), np.int32)
    totals = count_edges(
        gradients_of(to_grey(frame[top:bottom, left:right])),
        placement.pixels - (left, top),
        (window.half_width, window.half_height),
        (np.float32(feature.threshold) ** 2, np.float32(feature.floor) ** 2),
        (table.cells, TANGENTS, feature.signed),
        counts,
    )
    return compare_counts(counts, totals, (table.values, roots_up_to(window.width * window.height)))
