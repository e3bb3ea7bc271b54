"""The edge feature of P2, by the numba kernels."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np

from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.gradients import GradientDirections, window_peaks
from vehicle_pf_tracker.features.kernels.numba_edges import (
    TANGENTS,
    Numbers,
    count_points,
    find_points,
    gradient_strengths,
)
from vehicle_pf_tracker.features.kernels.numba_place import Place
from vehicle_pf_tracker.features.kernels.numba_reference import CellTable
from vehicle_pf_tracker.features.kernels.numba_windows import Counts
from vehicle_pf_tracker.features.window import Window
from vehicle_pf_tracker.features.window_feature import to_grey


class CellCounts(NamedTuple):
    """Counts of the table's cells (N, K + 1 or more), and of all bins together (N,)."""

    cells: Counts
    totals: Numbers


def count_directions(
    feature: GradientDirections, frame: Frame, place: Place, window: Window, table: CellTable
) -> CellCounts:
    """Count edge points by direction, the gradient taken in the frame."""
    # One pixel more makes every gradient in the windows that of the whole frame.
    left, top, right, bottom = place.covered(margin=1)
    grey = to_grey(frame[top:bottom, left:right])
    gx, gy = (
        np.asarray(cv2.Sobel(grey, cv2.CV_16S, dx, 1 - dx, ksize=3), np.int16) for dx in (1, 0)
    )
    strengths = gradient_strengths(gx, gy)
    limits = feature.limits(window_peaks(strengths, place.pixels - (left, top), window))
    # Only what passes the least limit of all can be an edge point in any window.
    images = gx, gy, strengths
    index, cells, passed = find_points(images, limits.min(), table.cells, TANGENTS, feature.signed)
    counts = np.empty((len(limits), len(table.values)), np.int32)
    rectangles = place.rectangles((left, top))
    return CellCounts(counts, count_points(index, cells, passed, rectangles, limits, counts))
