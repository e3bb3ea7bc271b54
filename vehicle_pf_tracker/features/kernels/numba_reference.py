"""What the numba kernels look up of a reference or of chosen bins."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.features.kernels.numba_cells import Table
from vehicle_pf_tracker.features.kernels.numba_windows import Reals
from vehicle_pf_tracker.features.reference import Histogram, Reference

_LANES = 16
"""Cells are padded to a multiple of this, so that loops over them fill vector registers."""

_MOST_ROOTS = 1 << 16


@dataclass(frozen=True, slots=True, eq=False)
class CellTable:
    """Which cell each bin has, and what a cell's count is worth.

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

    @classmethod
    def of(cls, active: npt.NDArray[np.intp], bins: int, values: Histogram) -> CellTable:
        """Make the table of the bins `active` with the reference's `values` there."""
        count = len(active)
        cells = np.full(bins, count, np.uint16)
        cells[active] = np.arange(count)
        padded = np.zeros(-(-(count + 1) // _LANES) * _LANES)
        np.sqrt(values, out=padded[:count])
        padded.flags.writeable = False
        return cls(cells, count, padded)


def table_for_counting(active: npt.NDArray[np.intp], bins: int) -> CellTable:
    """Table of the bins `active` without any reference."""
    return _all_bins(bins) if len(active) == bins else CellTable.of(active, bins, _zeros(active))


def table_of(reference: Reference) -> CellTable:
    """Table of a reference, made once."""
    kept = reference.kept.get("cells")
    if not isinstance(kept, CellTable):
        kept = CellTable.of(reference.active, len(reference.histogram), reference.values)
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
def _all_bins(bins: int) -> CellTable:
    every = np.arange(bins)
    return CellTable.of(every, bins, _zeros(every))


def _zeros(active: npt.NDArray[np.intp]) -> Histogram:
    return np.zeros(len(active))
