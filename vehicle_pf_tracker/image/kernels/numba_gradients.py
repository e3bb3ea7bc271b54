"""The edge feature of P2, by the numba kernels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.gradients import GradientDirections
from vehicle_pf_tracker.image.kernels.numba_edges import TANGENTS, Numbers, count_edges
from vehicle_pf_tracker.image.kernels.numba_place import Place
from vehicle_pf_tracker.image.kernels.numba_reference import CellTable
from vehicle_pf_tracker.image.kernels.numba_windows import Counts
from vehicle_pf_tracker.image.window_feature import to_grey


class CellCounts(NamedTuple):
    """Counts of the table's cells (N, K + 1 or more), and of all bins together (N,)."""

    cells: Counts
    totals: Numbers


def count_directions(
    feature: GradientDirections, frame: Frame, place: Place, table: CellTable
) -> CellCounts:
    """Count edge points by direction, the gradient taken in the frame."""
    # One pixel more makes every gradient in the windows that of the whole frame.
    left, top, right, bottom = place.covered(margin=1)
    counts = np.empty((len(place.pixels), len(table.values)), np.int32)
    totals = count_edges(
        to_grey(frame[top:bottom, left:right]),
        (left, top),
        (place.pixels, place.extent, (place.reach[0], place.reach[2])),
        (np.float32(feature.threshold) ** 2, np.float32(feature.floor) ** 2),
        (table.cells, TANGENTS, feature.signed),
        counts,
    )
    return CellCounts(counts, totals)
