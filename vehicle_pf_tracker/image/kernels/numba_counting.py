"""Features that count pixels, by the numba kernels: over a region, or window by window."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.joint_colour import JointColour
from vehicle_pf_tracker.image.kernels.numba_cells import (
    Cells,
    marginal_cells,
    pair_cells,
    stack_windows,
)
from vehicle_pf_tracker.image.kernels.numba_place import Place
from vehicle_pf_tracker.image.kernels.numba_reference import CellTable, roots_up_to
from vehicle_pf_tracker.image.kernels.numba_windows import (
    Counts,
    Reals,
    compare_joint,
    compare_rectangles,
    compare_windows,
    window_rectangles,
)
from vehicle_pf_tracker.image.rgb_marginals import CHANNEL_BINS, RgbMarginals
from vehicle_pf_tracker.image.window import Positions, Window
from vehicle_pf_tracker.image.window_feature import WindowFeature, to_grey


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
    place = Place.of(feature, frame, positions, window)
    left, top, right, bottom = place.covered()
    if (right - left) * (bottom - top) > len(place.pixels) * area:
        return _compare_apart(feature, frame, place, table, counts)
    cells = _cells(feature, frame[top:bottom, left:right], table)
    return compare_windows(
        cells, place.pixels, place.extent, (left, top), place.reach, scale, counts
    )


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
