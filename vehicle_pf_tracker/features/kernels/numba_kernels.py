"""The kernels in numba."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.features.frame import Frame, frame_size
from vehicle_pf_tracker.features.glcm import Cooccurrence
from vehicle_pf_tracker.features.joint_colour import JointColour
from vehicle_pf_tracker.features.kernels import numba_jit
from vehicle_pf_tracker.features.kernels.interface import Kernels, PixelRange, SimilarityMap
from vehicle_pf_tracker.features.kernels.numba_cells import (
    Cells,
    Rectangles,
    joint_cells,
    marginal_cells,
    pair_cells,
    stack_windows,
)
from vehicle_pf_tracker.features.kernels.numba_reference import CellTable, roots_up_to, table_of
from vehicle_pf_tracker.features.kernels.numba_windows import (
    Counts,
    Pixels,
    Reach,
    Reals,
    compare_rectangles,
    map_windows,
    slide_windows,
    window_pixels,
    window_rectangles,
)
from vehicle_pf_tracker.features.reference import Reference
from vehicle_pf_tracker.features.rgb_marginals import CHANNEL_BINS, RgbMarginals
from vehicle_pf_tracker.features.window import Positions, Window
from vehicle_pf_tracker.features.window_feature import (
    Coefficients,
    Counted,
    CountedFeature,
    WindowFeature,
    to_grey,
)

_NO_COUNTS: Counts = np.zeros((0, 0), np.int32)

# What things cost, roughly in cycles; they decide about the route, and not about the result.
_PIXEL = 4
_STEP = 10
_CELLS_AT_ONCE = 8


class Place(NamedTuple):
    """Where windows lie in a frame.

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
    ) -> Place:
        """Find the windows around positions."""
        size = frame_size(frame)
        found = window_pixels(positions, *size)
        (left, top), (right, bottom) = found[-2:].tolist()
        return cls(found[:-2], (left, top, right, bottom), _reach(feature, window), size)

    def covered(self) -> PixelRange:
        """Smallest part of the frame that has all windows in it."""
        (x0, y0, x1, y1), (left, _, up) = self.extent, self.reach
        width, height = self.size
        return PixelRange(
            max(x0 - left, 0),
            max(y0 - up, 0),
            min(x1 + left + 1, width),
            min(y1 + up + 1, height),
        )

    def rectangles(self, origin: tuple[int, int]) -> Rectangles:
        """Left, top, right, bottom of each window as seen from `origin`, shape (N, 4)."""
        return window_rectangles(self.pixels, self.reach, origin, self.size)


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
        if not is_compiled(feature):
            assert isinstance(feature, CountedFeature)
            return feature.counts(frame, positions, window, active)
        table = CellTable.of(active, feature.bins, np.zeros(len(active)))
        counts = np.empty((len(positions), len(active)), np.int32)
        place = Place.of(feature, frame, positions, window)
        _compare(feature, frame, place, table, counts)
        left, top, right, bottom = place.rectangles((0, 0)).T
        return Counted(counts, _planes(feature) * (right - left) * (bottom - top))

    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows; see `Kernels.similarity`."""
        if not is_compiled(feature):
            return feature.similarity(frame, positions, window, reference)
        place = Place.of(feature, frame, positions, window)
        return _compare(feature, frame, place, table_of(reference), _NO_COUNTS)

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
        return map_windows(cells, extent, _reach(feature, window), table.single)


def is_compiled(feature: WindowFeature) -> bool:
    """Whether there are compiled kernels for a feature."""
    return isinstance(feature, JointColour | RgbMarginals | Cooccurrence)


def _compare(
    feature: WindowFeature, frame: Frame, place: Place, table: CellTable, counts: Counts
) -> Reals:
    """Compare windows from the region that they cover, or apart where that is less work."""
    left, top, right, bottom = place.covered()
    area = (place.reach[0] * 2 + 1) * (place.reach[2] * 2 + 1)
    planes, roots = _planes(feature), roots_up_to(_planes(feature) * area)
    if (right - left) * (bottom - top) > len(place.pixels) * area:
        return _compare_apart(feature, frame, place, table, counts)
    cells = _cells(feature, frame[top:bottom, left:right], table)
    if _work_of_sliding(place, cells, table) > len(place.pixels) * (
        _PIXEL * planes * area + len(table.values)
    ):
        rectangles = place.rectangles((left, top))
        return compare_rectangles(cells, rectangles, (table.values, roots), counts)
    return slide_windows(
        cells, place.pixels, place.extent, (left, top), place.reach, (table.values, roots), counts
    )


def _work_of_sliding(place: Place, cells: Cells, table: CellTable) -> int:
    x0, y0, x1, y1 = place.extent
    step = len(table.values) // _CELLS_AT_ONCE
    each_row = (x1 - x0 + 1) * (step + _STEP) + (2 * place.reach[0] + 1) * step
    return _PIXEL * cells.size + (y1 - y0 + 1) * each_row


def _compare_apart(
    feature: WindowFeature, frame: Frame, place: Place, table: CellTable, counts: Counts
) -> Reals:
    """Compare windows that share few pixels, from a copy of each."""
    width, height = 2 * place.reach[0] + 1, 2 * place.reach[2] + 1
    whole = window_rectangles(
        place.pixels, (place.reach[0], place.reach[0] + 1, place.reach[2]), (0, 0), place.size
    )
    stack = stack_windows(frame, whole, width, height)
    rectangles = place.rectangles((0, 0))
    rectangles[:, [0, 2]] -= whole[:, :1]
    rectangles[:, [1, 3]] += (height * np.arange(len(whole)) - whole[:, 1])[:, np.newaxis]
    roots = roots_up_to(_planes(feature) * width * height)
    return compare_rectangles(
        _cells(feature, stack, table), rectangles, (table.values, roots), counts
    )


def _cells(feature: WindowFeature, pixels: Frame, table: CellTable) -> Cells:
    if isinstance(feature, JointColour):
        return joint_cells(pixels, feature.bits, table.cells)
    if isinstance(feature, RgbMarginals):
        return marginal_cells(pixels, CHANNEL_BINS, table.cells)
    return pair_cells(to_grey(pixels), table.cells)


def _planes(feature: WindowFeature) -> int:
    return 3 if isinstance(feature, RgbMarginals) else 1


def _reach(feature: WindowFeature, window: Window) -> Reach:
    right = window.half_width + (0 if isinstance(feature, Cooccurrence) else 1)
    return window.half_width, right, window.half_height
