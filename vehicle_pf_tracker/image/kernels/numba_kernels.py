"""The kernels in numba."""

from __future__ import annotations

from typing import TypeGuard

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.glcm import Cooccurrence
from vehicle_pf_tracker.image.gradients import GradientDirections
from vehicle_pf_tracker.image.joint_colour import JointColour
from vehicle_pf_tracker.image.kernels import numba_jit
from vehicle_pf_tracker.image.kernels.interface import Kernels, PixelRange, SimilarityMap
from vehicle_pf_tracker.image.kernels.numba_cells import Cells
from vehicle_pf_tracker.image.kernels.numba_counting import compare_pixels, planes_of
from vehicle_pf_tracker.image.kernels.numba_gradients import count_directions
from vehicle_pf_tracker.image.kernels.numba_mean_shift import (
    compare_kernels,
    ellipse,
    shift_kernels,
)
from vehicle_pf_tracker.image.kernels.numba_place import Place, reach_of
from vehicle_pf_tracker.image.kernels.numba_reference import (
    CellTable,
    roots_up_to,
    table_for_counting,
    table_of,
    table_of_all,
)
from vehicle_pf_tracker.image.kernels.numba_windows import (
    Counts,
    compare_counts,
    joint_cells,
    map_windows,
)
from vehicle_pf_tracker.image.reference import Reference
from vehicle_pf_tracker.image.rgb_marginals import RgbMarginals
from vehicle_pf_tracker.image.window import Positions, Window
from vehicle_pf_tracker.image.window_feature import (
    Coefficients,
    Counted,
    CountedFeature,
    Histograms,
    WindowFeature,
)

_OF_PIXELS = {JointColour, RgbMarginals, Cooccurrence}
_NO_COUNTS: Counts = np.zeros((0, 0), np.int32)


class NumbaKernels(Kernels):
    """Compiled kernels; importing this module compiles them, or loads what was compiled before."""

    name = "numba"

    def __init__(self) -> None:
        self.notices = numba_jit.notices()

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
            place = Place.of(feature, frame, positions, window)
            cells, totals = count_directions(feature, frame, place, table)
            return Counted(cells[:, : table.active], totals)
        if counts_pixels(feature):
            place = Place.of(feature, frame, positions, window)
            counts = np.empty((len(positions), table.active), np.int32)
            compare_pixels(feature, frame, positions, window, table, counts)
            left, top, right, bottom = place.rectangles((0, 0)).T
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
            place, table = Place.of(feature, frame, positions, window), table_of(reference)
            cells, totals = count_directions(feature, frame, place, table)
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
        place, table = Place.of(feature, frame, positions, window), table_of(reference)
        cells, origin = _covered_cells(feature, frame, place, table)
        return compare_kernels(cells, place.pixels, origin, offsets, (profile, table.values))

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
        place, table = Place.of(feature, frame, positions, window), table_of(reference)
        cells, origin = _covered_cells(feature, frame, place, table)
        steps = shift_kernels(cells, place.pixels, origin, offsets, (profile, table.values))
        return np.where(np.isnan(steps), positions, place.pixels + 0.5 + steps)


def _covered_cells(
    feature: JointColour, frame: Frame, place: Place, table: CellTable
) -> tuple[Cells, tuple[int, int]]:
    left, top, right, bottom = place.covered()
    return joint_cells(frame[top:bottom, left:right], feature.bits, table.cells), (left, top)


def counts_pixels(feature: WindowFeature) -> bool:
    """Whether every pixel counts alike in all windows."""
    return type(feature) in _OF_PIXELS


def counts_edges(feature: WindowFeature) -> TypeGuard[GradientDirections]:
    """Whether edge points of the frame's own gradient are counted."""
    return type(feature) is GradientDirections and feature.in_frame
