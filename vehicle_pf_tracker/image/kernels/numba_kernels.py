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

"""The kernels in numba."""

from __future__ import annotations

from typing import TypeGuard

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.colour import CHANNEL_BINS, JointColour, RgbMarginals
from vehicle_pf_tracker.image.correlation_filter import Places
from vehicle_pf_tracker.image.gradient_cells import CellFeatures, Grey
from vehicle_pf_tracker.image.gradients import GradientDirections
from vehicle_pf_tracker.image.kernels import numba_jit, numba_shared_motion, numba_spectra
from vehicle_pf_tracker.image.kernels.interface import Kernels, PixelRange, SimilarityMap
from vehicle_pf_tracker.image.kernels.numba_edges import count_directions
from vehicle_pf_tracker.image.kernels.numba_gradient_cells import gradient_cells
from vehicle_pf_tracker.image.kernels.numba_inputs import (
    CellTable,
    Placement,
    reach_of,
    roots_up_to,
    table_for_counting,
    table_of,
    table_of_all,
    window_rectangles,
)
from vehicle_pf_tracker.image.kernels.numba_jit import (
    Cells,
    marginal_cells,
    pair_cells,
    stack_windows,
)
from vehicle_pf_tracker.image.kernels.numba_mean_shift import (
    compare_kernels,
    ellipse,
    shift_kernels,
)
from vehicle_pf_tracker.image.kernels.numba_windows import (
    Counts,
    Reals,
    compare_counts,
    compare_joint,
    compare_rectangles,
    compare_windows,
    joint_cells,
    map_windows,
)
from vehicle_pf_tracker.image.shared_motion import Alive, CellBlock, Flow
from vehicle_pf_tracker.image.similarity import Reference
from vehicle_pf_tracker.image.spectra import FilterProblem, Penalty, Spectrum
from vehicle_pf_tracker.image.textures import Cooccurrence
from vehicle_pf_tracker.image.window import (
    Coefficients,
    Counted,
    CountedFeature,
    Histograms,
    Positions,
    Window,
    WindowFeature,
    to_grey,
)


def compare_pixels(
    feature: WindowFeature,
    frame: Frame,
    positions: Positions,
    window: Window,
    table: CellTable,
    counts: Counts,
) -> Reals:
    """Compare windows from the region that they cover, or apart where that is less work.

    Parameters
    ----------
    feature : WindowFeature
        Joint colours, marginals or co-occurrences.
    frame, positions, window
        As for `Kernels.similarity`.
    table : CellTable
        Of the reference, or of what to count.
    counts : (N or 0, K) array
        Filled with each window's counts, if it has room.

    Returns
    -------
    (N,) array
        Bhattacharyya coefficients.
    """
    area = window.width * window.height
    scale = table.values, roots_up_to(planes_of(feature) * area)
    if isinstance(feature, JointColour):
        half = window.half_width, window.half_height
        return compare_joint(frame, positions, feature.bits, half, table.cells, scale, counts)
    placement = Placement.of(feature, frame, positions, window)
    left, top, right, bottom = placement.covered()
    if (right - left) * (bottom - top) > len(placement.pixels) * area:
        return _compare_apart(feature, frame, placement, table, counts)
    cells = _cells(feature, frame[top:bottom, left:right], table)
    return compare_windows(
        cells, placement.pixels, placement.extent, (left, top), placement.reach, scale, counts
    )


def _compare_apart(
    feature: WindowFeature, frame: Frame, placement: Placement, table: CellTable, counts: Counts
) -> Reals:
    """Compare windows that share few pixels, from a copy of each."""
    width, height = 2 * placement.reach[0] + 1, 2 * placement.reach[2] + 1
    whole = window_rectangles(
        placement.pixels,
        (placement.reach[0], placement.reach[0] + 1, placement.reach[2]),
        (0, 0),
        placement.size,
    )
    stack = stack_windows(frame, whole, width, height)
    rectangles = placement.rectangles((0, 0))
    rectangles[:, [0, 2]] -= whole[:, :1]
    rectangles[:, [1, 3]] += (height * np.arange(len(whole)) - whole[:, 1])[:, np.newaxis]
    roots = roots_up_to(planes_of(feature) * width * height)
    return compare_rectangles(
        _cells(feature, stack, table), rectangles, (table.values, roots), counts
    )


def _cells(feature: WindowFeature, pixels: Frame, table: CellTable) -> Cells:
    if isinstance(feature, RgbMarginals):
        return marginal_cells(pixels, CHANNEL_BINS, table.cells)
    return pair_cells(to_grey(pixels), table.cells)


def planes_of(feature: WindowFeature) -> int:
    """Count the bins that each pixel adds to."""
    return 3 if type(feature) is RgbMarginals else 1


_OF_PIXELS = {JointColour, RgbMarginals, Cooccurrence}
_NO_COUNTS: Counts = np.zeros((0, 0), np.int32)


class NumbaKernels(Kernels):
    """Compiled kernels; importing this module compiles them, or loads what was compiled before."""

    name = "numba"

    def __init__(self) -> None:
        self.notices = numba_jit.notices()

    def gradient_cells(self, grey: Grey, spare: int = 0) -> CellFeatures:
        """Compute gradient histograms; see `Kernels.gradient_cells`."""
        return gradient_cells(grey, spare)

    def take_filter_step(
        self, problem: FilterProblem, penalty: Penalty, multiplier: Spectrum, confined: Spectrum
    ) -> None:
        """Train a filter by one step; see `Kernels.take_filter_step`."""
        numba_spectra.take_filter_step(problem, penalty, multiplier, confined)

    def correlated(self, spectrum: Spectrum, weights: Spectrum) -> Spectrum:
        """Correlate and sum over channels; see `Kernels.correlated`."""
        return numba_spectra.correlated(spectrum, weights)

    def shifted(self, spectrum: Spectrum, x: float, y: float) -> Spectrum:
        """Move cells; see `Kernels.shifted`."""
        return numba_spectra.shifted(spectrum, x, y)

    def shared_similarity(self, before: Array, after: Array) -> Array:
        """Fit a similarity; see `Kernels.shared_similarity`."""
        return numba_shared_motion.shared_similarity(before, after)

    def staying(self, before: Array, after: Array, alive: Alive, strayed: float) -> Alive:
        """Tell which places turn with most; see `Kernels.staying`."""
        return numba_shared_motion.staying(before, after, alive, strayed)

    def shared_stretch(self, before: Array, after: Array, size: Array) -> Array:
        """Change of distances; see `Kernels.shared_stretch`."""
        return numba_shared_motion.shared_stretch(before, after, size)

    def carried_share(
        self, flow: Flow, cells: CellBlock, places: Array, vehicle: Array, background: Array
    ) -> float:
        """Share that moved with the vehicle; see `Kernels.carried_share`."""
        return numba_shared_motion.carried_share(flow, cells, places, vehicle, background)

    def climbed(self, values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
        """Move places; see `Kernels.climbed`."""
        return numba_spectra.climbed(values, places, costs)

    def counts(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        active: npt.NDArray[np.intp],
    ) -> Counted:
        """Count windows; see `Kernels.counts`."""
        table = table_for_counting(active, feature.bins)
        if counts_edges(feature):
            placement = Placement.of(feature, frame, positions, window)
            cells, totals = count_directions(feature, frame, placement, table)
            return Counted(cells[:, : table.active], totals)
        if counts_pixels(feature):
            placement = Placement.of(feature, frame, positions, window)
            counts = np.empty((len(positions), table.active), np.int32)
            compare_pixels(feature, frame, positions, window, table, counts)
            left, top, right, bottom = placement.rectangles((0, 0)).T
            return Counted(counts, planes_of(feature) * (right - left) * (bottom - top))
        assert isinstance(feature, CountedFeature)
        return feature.counts(frame, positions, window, active)

    def histograms(
        self, feature: WindowFeature, frame: Frame, positions: Positions, window: Window
    ) -> Histograms:
        """Describe windows; see `Kernels.histograms`."""
        if not counts_pixels(feature):
            return super().histograms(feature, frame, positions, window)
        counts = np.empty((len(positions), feature.bins), np.int32)
        compare_pixels(feature, frame, positions, window, table_of_all(feature.bins), counts)
        return np.asarray(counts / np.maximum(counts.sum(axis=1, keepdims=True), 1))

    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows; see `Kernels.similarity`."""
        if counts_pixels(feature):
            table = table_of(reference)
            return compare_pixels(feature, frame, positions, window, table, _NO_COUNTS)
        if counts_edges(feature):
            placement, table = Placement.of(feature, frame, positions, window), table_of(reference)
            cells, totals = count_directions(feature, frame, placement, table)
            roots = roots_up_to(window.width * window.height)
            return compare_counts(cells, totals, (table.values, roots))
        return feature.similarity(frame, positions, window, reference)

    def similarity_map(
        self,
        feature: JointColour,
        frame: Frame,
        window: Window,
        reference: Reference,
        pixels: PixelRange | None = None,
    ) -> SimilarityMap:
        """Compare all windows; see `Kernels.similarity_map`."""
        width, height = frame_size(frame)
        left, top, right, bottom = pixels or PixelRange(0, 0, width, height)
        x, y = max(left - window.half_width, 0), max(top - window.half_height, 0)
        region = frame[y : bottom + window.half_height, x : right + window.half_width]
        table = table_of(reference)
        cells = joint_cells(region, feature.bits, table.cells)
        extent = left - x, top - y, right - x, bottom - y
        return map_windows(
            cells, extent, reach_of(feature, window), table.values.astype(np.float32)
        )

    def kernel_similarity(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare; see `Kernels.kernel_similarity`."""
        offsets, profile = ellipse(window)
        placement, table = Placement.of(feature, frame, positions, window), table_of(reference)
        cells, origin = _covered_cells(feature, frame, placement, table)
        return compare_kernels(cells, placement.pixels, origin, offsets, (profile, table.values))

    def mean_shift(
        self,
        feature: JointColour,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Positions:
        """Move; see `Kernels.mean_shift`."""
        offsets, profile = ellipse(window)
        placement, table = Placement.of(feature, frame, positions, window), table_of(reference)
        cells, origin = _covered_cells(feature, frame, placement, table)
        steps = shift_kernels(cells, placement.pixels, origin, offsets, (profile, table.values))
        return np.where(np.isnan(steps), positions, placement.pixels + 0.5 + steps)


def _covered_cells(
    feature: JointColour, frame: Frame, placement: Placement, table: CellTable
) -> tuple[Cells, tuple[int, int]]:
    left, top, right, bottom = placement.covered()
    return joint_cells(frame[top:bottom, left:right], feature.bits, table.cells), (left, top)


def counts_pixels(feature: WindowFeature) -> bool:
    """Test whether each pixel counts equally in all windows."""
    return type(feature) in _OF_PIXELS


def counts_edges(feature: WindowFeature) -> TypeGuard[GradientDirections]:
    """Test whether edge points of the frame's gradient are counted."""
    return type(feature) is GradientDirections and feature.in_frame
