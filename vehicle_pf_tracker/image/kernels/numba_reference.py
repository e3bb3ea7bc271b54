"""What the numba kernels look up of a reference or of chosen bins."""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import types

from vehicle_pf_tracker.image.kernels.numba_cells import Table
from vehicle_pf_tracker.image.kernels.numba_jit import compiled
from vehicle_pf_tracker.image.kernels.numba_windows import Reals
from vehicle_pf_tracker.image.reference import Histogram, Reference

_LANES = 16
"""Cells are padded to a multiple of this, so that loops over them fill vector registers."""

_MOST_ROOTS = 1 << 16

_HISTOGRAM = types.Array(types.float64, 1, "A", readonly=True)


class CellTable(NamedTuple):
    """Which cell each bin has, and what a cell's count is worth.

    Attributes
    ----------
    cells : (bins,) array of uint16
        Position of each active bin among the K active ones, K for all others.
    active : int
        K.
    values : (K + 1 or more,) array
        Square roots of the reference at the active bins, followed by zeros; of no meaning where
        bins are only counted.
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


def table_for_counting(active: npt.NDArray[np.intp], bins: int) -> CellTable:
    """Table of the bins `active` without any reference."""
    if len(active) == bins:
        return table_of_all(bins)
    chosen = np.zeros(bins)
    chosen[active] = 1.0
    return CellTable(*_number_cells(chosen))


def table_of(reference: Reference) -> CellTable:
    """Table of a reference, made once."""
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


@functools.lru_cache(maxsize=8)
def table_of_all(bins: int) -> CellTable:
    """Table of all bins without any reference."""
    return CellTable(*_number_cells(np.ones(bins)))
