"""The edge feature of P2, by the numba kernels."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.features.gradients import GradientDirections, window_peaks
from vehicle_pf_tracker.features.kernels.numba_cells import Rectangles
from vehicle_pf_tracker.features.kernels.numba_edges import (
    TANGENTS,
    Images,
    Limits,
    Numbers,
    count_points,
    find_points,
    gradient_strengths,
)
from vehicle_pf_tracker.features.kernels.numba_place import Place
from vehicle_pf_tracker.features.kernels.numba_reference import CellTable
from vehicle_pf_tracker.features.kernels.numba_windows import Counts
from vehicle_pf_tracker.features.sobel import Strengths
from vehicle_pf_tracker.features.window import Window
from vehicle_pf_tracker.features.window_feature import to_grey


class CellCounts(NamedTuple):
    """Counts of the table's cells (N, K + 1 or more), and of all bins together (N,)."""

    cells: Counts
    totals: Numbers


_MANY = 1000
"""Points that are worth a second count."""

_LOW = 0.25
"""Share of the middle limit below which a window is counted apart."""


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
    images, rectangles = (gx, gy, strengths), place.rectangles((left, top))
    low = _windows_apart(strengths, limits)
    if low is None:
        return _count(images, rectangles, limits, table, signed=feature.signed)
    counts = np.empty((len(limits), len(table.values)), np.int32)
    totals = np.empty(len(limits), np.int64)
    for group, part in ((~low, images), (low, _covered(images, rectangles[low]))):
        counts[group], totals[group] = _count(
            part, rectangles[group], limits[group], table, signed=feature.signed
        )
    return CellCounts(counts, totals)


def _windows_apart(strengths: Strengths, limits: Limits) -> npt.NDArray[np.bool_] | None:
    """Tell which windows are better counted apart, whose limits let points of all others pass."""
    low = limits < _LOW * np.partition(limits, len(limits) // 2)[len(limits) // 2]
    if not low.any():
        return None
    added = (strengths >= limits.min()) & (strengths < limits[~low].min())
    return low if np.count_nonzero(added) > _MANY else None


def _covered(images: Images, rectangles: Rectangles) -> Images:
    """Keep the gradient where some windows are, and nothing elsewhere passes any limit."""
    left, top = rectangles[:, :2].min(axis=0)
    right, bottom = rectangles[:, 2:].max(axis=0)
    gx, gy, strengths = images
    kept = np.full_like(strengths, -1.0)
    kept[top:bottom, left:right] = strengths[top:bottom, left:right]
    return gx, gy, kept


def _count(
    images: Images, rectangles: Rectangles, limits: Limits, table: CellTable, *, signed: bool
) -> CellCounts:
    # Only what passes the least limit of all can be an edge point in any window.
    index, cells, passed = find_points(images, limits.min(), table.cells, TANGENTS, signed)
    counts = np.empty((len(limits), len(table.values)), np.int32)
    return CellCounts(counts, count_points(index, cells, passed, rectangles, limits, counts))
