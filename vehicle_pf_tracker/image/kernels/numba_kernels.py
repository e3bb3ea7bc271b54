# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The kernels in numba, and windows and references in the form that they take.

Each kernel is compiled, or loaded, when it is first called (`kernel.Kernel`).
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.correlation.gradient_cells import CellFeatures
from vehicle_pf_tracker.image.correlation.map_search import Places
from vehicle_pf_tracker.image.kernels import (
    numba_box_colours,
    numba_box_motion,
    numba_cells,
    numba_counts,
    numba_edges,
    numba_gradients,
    numba_map_search,
    numba_mean_shift,
    numba_pixel_cells,
    numba_placing,
    numba_row_waves,
    numba_windows,
)
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.kernels.numba_edges import Numbers
from vehicle_pf_tracker.image.kernels.numba_pixel_cells import (
    joint_cells,
    joint_shares,
    marginal_cells,
    number_cells,
    pair_cells,
)
from vehicle_pf_tracker.image.kernels.numba_types import Cells, Counts, Pixels, Reals, Table
from vehicle_pf_tracker.image.kernels.toolchain import kernel
from vehicle_pf_tracker.image.windows.colour import CHANNEL_BINS, JointColour, RgbMarginals
from vehicle_pf_tracker.image.windows.gradients import DIRECTION_BINS, GradientDirections
from vehicle_pf_tracker.image.windows.similarity import Histogram, Reference
from vehicle_pf_tracker.image.windows.textures import Cooccurrence
from vehicle_pf_tracker.image.windows.window import (
    Coefficients,
    Grey,
    Positions,
    Window,
    WindowFeature,
    bounds_of_one,
    to_grey,
)

_MODULES = (
    numba_windows,
    numba_pixel_cells,
    numba_placing,
    numba_gradients,
    numba_edges,
    numba_counts,
    numba_mean_shift,
    numba_cells,
    numba_row_waves,
    numba_map_search,
    numba_box_colours,
    numba_box_motion,
)

_LANES = 16
"""Cells are padded to a multiple of this, so that loops over them fill vector registers: the
widest, of 512 bits, hold 16 counts."""

_MOST_ROOTS = 1 << 16
"""Largest table of square roots: 512 KB, which fits the second-level cache of common
processors."""


def load_all() -> None:
    """Compile or load every kernel."""
    for module in _MODULES:
        for one_kernel in kernel.kernels_of(module):
            one_kernel.prepare()


class CellTable(NamedTuple):
    """Cell of each bin, and the factor of each cell's count.

    Attributes
    ----------
    cells : (bins,) array of uint16
        Position of each active bin among the K active ones, K for all others.
    values : (K + 1 or more,) array
        Square roots of the reference at the active bins, followed by zeros.
    """

    cells: Table
    values: Reals


# A choice: references of several features and trackers of one process, some KB each.
@functools.lru_cache(maxsize=32)
def table_of(reference: Reference) -> CellTable:
    """Return the table of a reference, computed once."""
    return CellTable(*number_cells(reference.histogram, _LANES))


# A choice: fewer features are in use at a time, and a table has some KB.
@functools.lru_cache(maxsize=8)
def _every_bin(bins: int) -> Table:
    """Table in which the cell of each bin is its own number, to count all."""
    table = np.arange(bins, dtype=np.uint16)
    # Cached arrays are shared between trackers.
    table.flags.writeable = False
    return table


def roots_up_to(count: int) -> Reals:
    """Square roots of 0 to `count` or more, as far as a table of them is worth while."""
    # Powers of two: windows of nearly one size share a table.
    return _roots(min(1 << int(count).bit_length(), _MOST_ROOTS))


# There are 17 powers of two up to `_MOST_ROOTS`.
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
    """Compare kernel-weighted histograms; see `image.windows.mean_shift`."""
    cells, pixels, _ = _placed_cells(frame, positions, window, reference, bits)
    values = table_of(reference).values
    similarity: Coefficients = numba_mean_shift.compare_kernels(
        cells, pixels, *numba_mean_shift.ellipse(window), values
    )
    return similarity


def mean_shift(
    frame: Frame, positions: Positions, window: Window, reference: Reference, bits: int
) -> Positions:
    """Move every position one mean-shift step; see `image.windows.mean_shift`."""
    cells, pixels, first = _placed_cells(frame, positions, window, reference, bits)
    values = table_of(reference).values
    steps = numba_mean_shift.shift_kernels(cells, pixels, *numba_mean_shift.ellipse(window), values)
    # Pixels are integers from the first one covered; their middles are half a pixel further.
    return np.where(np.isnan(steps), positions, pixels + first + 0.5 + steps)


def _placed_cells(
    frame: Frame, positions: Positions, window: Window, reference: Reference, bits: int
) -> tuple[Cells, Pixels, tuple[int, int]]:
    """Return cells of the part that windows cover, their middles in it, and its first pixel."""
    # Only the part of the frame that windows cover is numbered: cost follows them, not the frame.
    half = window.half_width, window.half_height
    pixels, (left, top, right, bottom) = numba_placing.place_windows(
        positions, frame_size(frame), half, 0
    )
    cells = joint_cells(frame[top:bottom, left:right], bits, table_of(reference).cells)
    return cells, pixels, (left, top)


def gradient_cells(grey: Grey, spare: int = 0) -> CellFeatures:
    """Describe cells of a grey image; see `image.correlation.gradient_cells`."""
    features: CellFeatures = numba_cells.gradient_cells(grey, spare)
    return features


def climbed(values: Reals, places: Places, costs: Reals) -> tuple[Places, Reals]:
    """Move places on a map; see `image.correlation.map_search`."""
    best: tuple[Places, Reals] = numba_map_search.climbed(values, places, costs)
    return best


def count_colours(frame: Frame, boxes: Pixels, covers: Pixels, ends: Pixels) -> Counts:
    """Count the pixels of each colour in boxes; see `image.windows.box_colours`."""
    counts: Counts = numba_box_colours.count_colours(frame, boxes, covers, ends)
    return counts


class NumbaKernels(Kernels):
    """Compiled kernels, each of which is compiled, or loaded, when it is first called."""

    name = "numba"

    carried_share = staticmethod(numba_box_motion.carried_share)
    climbed = staticmethod(climbed)
    count_colours = staticmethod(count_colours)
    gradient_cells = staticmethod(gradient_cells)
    kernel_similarity = staticmethod(kernel_similarity)
    mean_shift = staticmethod(mean_shift)
    row_waves = numba_row_waves.CompiledRowWaves()
    staying = staticmethod(numba_box_motion.staying)

    def __init__(self) -> None:
        super().__init__(kernel.notices())

    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows; see `Kernels.similarity`."""
        table = table_of(reference)
        # The very type: a subclass may count otherwise.
        if type(feature) in _COUNTED_PIXELS:
            return _compare_pixels(feature, frame, positions, window, table)
        # Gradients of each window by itself, as printed, share nothing: they have no kernel.
        if type(feature) is GradientDirections and feature.in_frame:
            return _compare_edges(feature, frame, positions, window, table)
        return super().similarity(feature, frame, positions, window, reference)

    def histogram(
        self, feature: WindowFeature, frame: Frame, position: tuple[float, float], window: Window
    ) -> Histogram:
        """Describe one window; see `Kernels.histogram`."""
        if type(feature) in _COUNTED_PIXELS:
            return _histogram_of_pixels(feature, frame, position, window)
        if type(feature) is GradientDirections and feature.in_frame:
            return _histogram_of_edges(feature, frame, position, window)
        return super().histogram(feature, frame, position, window)


def _histogram_of_pixels(
    feature: WindowFeature, frame: Frame, position: tuple[float, float], window: Window
) -> Histogram:
    """Count every bin of one window's pixels."""
    left, top, right, bottom = bounds_of_one(frame, position, window)
    part = frame[top:bottom, left:right]
    if isinstance(feature, JointColour):
        shares: Histogram = joint_shares(part, feature.bits)
        return shares
    table = _every_bin(feature.bins)
    if isinstance(feature, RgbMarginals):
        cells = marginal_cells(part, CHANNEL_BINS, table)
    else:
        cells = pair_cells(to_grey(part), table)
    # Of one window there is nothing to share.
    counts = np.bincount(cells.ravel(), minlength=feature.bins)
    return np.asarray(counts / max(cells.size, 1))


def _histogram_of_edges(
    feature: GradientDirections, frame: Frame, position: tuple[float, float], window: Window
) -> Histogram:
    """Count every direction of one window's edge points, the gradient taken in the frame."""
    counts = np.empty((1, DIRECTION_BINS), np.int32)
    totals = _count_edges(
        feature, frame, np.array([position]), window, _every_bin(DIRECTION_BINS), counts
    )
    return np.asarray(counts[0] / max(int(totals[0]), 1))


def _compare_pixels(
    feature: WindowFeature, frame: Frame, positions: Positions, window: Window, table: CellTable
) -> Reals:
    """Compare windows by their pixels."""
    # Each pixel counts once in each of its planes.
    planes = 3 if type(feature) is RgbMarginals else 1
    scale = table.values, roots_up_to(planes * window.width * window.height)
    half = window.half_width, window.half_height
    if isinstance(feature, JointColour):
        similarity: Reals = numba_windows.compare_joint(
            frame, positions, feature.bits, half, table.cells, scale
        )
        return similarity
    # Cells are made once for the part that all windows share.
    pixels, (left, top, right, bottom) = numba_placing.place_windows(
        positions, frame_size(frame), half, 0
    )
    part = frame[top:bottom, left:right]
    if isinstance(feature, RgbMarginals):
        cells = marginal_cells(part, CHANNEL_BINS, table.cells)
        beside = window.half_width + 1
    else:  # pairs end one column earlier
        cells = pair_cells(to_grey(part), table.cells)
        beside = window.half_width
    reach = window.half_width, beside, window.half_height
    compared: Reals = numba_windows.compare_windows(cells, pixels, reach, scale)
    return compared


def _compare_edges(
    feature: GradientDirections,
    frame: Frame,
    positions: Positions,
    window: Window,
    table: CellTable,
) -> Reals:
    """Compare windows by the directions of their edge points, the gradient taken in the frame."""
    # Filled by the kernel, so that it allocates nothing per window.
    counts = np.empty((len(positions), len(table.values)), np.int32)
    totals = _count_edges(feature, frame, positions, window, table.cells, counts)
    # Edge points are at most the pixels of a window.
    scale = table.values, roots_up_to(window.width * window.height)
    similarity: Reals = numba_counts.compare_counts(counts, totals, scale)
    return similarity


def _count_edges(
    feature: GradientDirections,
    frame: Frame,
    positions: Positions,
    window: Window,
    cells: Table,
    counts: Counts,
) -> Numbers:
    """Fill the counts (N, K + 1 or more) of the edge points' cells; their totals (N,)."""
    half = window.half_width, window.half_height
    # One pixel more makes every gradient in the windows that of the whole frame.
    pixels, (left, top, right, bottom) = numba_placing.place_windows(
        positions, frame_size(frame), half, 1
    )
    grey = to_grey(frame[top:bottom, left:right])
    totals: Numbers = numba_edges.count_edges(
        numba_gradients.gradients(grey),
        pixels,
        half,
        # Squared, as the strengths are, and in float32, as the version in numpy compares them.
        (np.float32(feature.threshold) ** 2, np.float32(feature.floor) ** 2),
        (cells, numba_edges.TANGENTS, feature.signed),
        counts,
    )
    return totals
