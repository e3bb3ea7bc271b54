# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fourier transforms of parts of a square, as matrix products.

A filter that is confined to its target has a tenth of the square's cells. Of the transform of 34
channels of 32 x 32 cells only so much has to be computed; that takes a quarter of the time of whole
fast transforms.
"""

from __future__ import annotations

import functools
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.products import product
from vehicle_pf_tracker.image.correlation.gradient_cells import CellFeatures
from vehicle_pf_tracker.image.correlation.row_waves import RowWaves, Spectrum

_Matrix: TypeAlias = npt.NDArray[np.float32]
BY_NUMPY = RowWaves()
"""Exchange of rows and waves where no compiled one is given."""


class PartialFourier:
    """Transforms between the cells of a part of a square and the half spectrum of the square.

    Parameters
    ----------
    cells : int
        Cells along each side of the square; even.
    rows, columns : slice
        The part; what is outside is zero, or of no interest.
    window : (cells,) array or None
        Weights along both axes that cells are multiplied by before they are transformed.
    """

    def __init__(
        self, cells: int, rows: slice, columns: slice, window: Array | None = None
    ) -> None:
        # Matrices are made once: a part and its square keep their size while a target is followed.
        places = np.arange(cells)
        weights = np.ones(cells) if window is None else window
        # What is zero outside the part needs no rows or columns of the matrices.
        y, x = places[rows], places[columns]
        self._from_rows = np.asarray(_waves(y, cells).T * weights[rows], np.float32)
        self._to_rows = np.asarray(_waves(y, cells) / cells, np.float32)
        self._from_columns = _pairs(x, cells, weights[columns, np.newaxis])
        self._to_columns = _to_columns(x, cells)

    def cells_of(self, spectrum: Spectrum, waves: RowWaves = BY_NUMPY) -> CellFeatures:
        """Cells of the part, (channels, rows, columns)."""
        # Through the rows first: the part has few of them, and what follows is that much less.
        return product(product(self._to_rows, waves.of(spectrum)), self._to_columns)

    def spectrum_of(self, cells: CellFeatures, waves: RowWaves = BY_NUMPY) -> Spectrum:
        """Half spectrum of the square from the cells of the part."""
        return waves.joined(product(product(self._from_rows, cells), self._from_columns))


@functools.cache
def frequencies(cells: int) -> npt.NDArray[np.intp]:
    """Frequency along y of each row of a spectrum: the two without a negative one come first."""
    positive = np.arange(1, cells // 2)
    return np.concatenate([[0, -(cells // 2)], positive, -positive])


def upsampled(spectrum: Spectrum, upsampling: int, waves: RowWaves = BY_NUMPY) -> _Matrix:
    """Inverse transform of a half spectrum (n, n // 2 + 1), `upsampling` places per cell.

    Zero is in the middle. The highest frequency along x, which has no phase, is left out.
    """
    down, right = _fine_transforms(len(spectrum), upsampling)
    return product(product(down, waves.of(spectrum[np.newaxis])[0]), right)


def shifted(spectrum: Spectrum, x: float, y: float) -> Spectrum:
    """Spectrum of the same cells moved by (x, y) cells, circularly."""
    cells = spectrum.shape[1]
    # A shift is a phase at each frequency: exact, for fractions of a cell too.
    down = np.exp(-2j * np.pi / cells * y * frequencies(cells))[:, np.newaxis]
    right = np.exp(-2j * np.pi / cells * x * np.arange(cells // 2 + 1))
    return np.asarray(spectrum * (down * right).astype(np.complex64))


@functools.cache
def _fine_transforms(cells: int, upsampling: int) -> tuple[_Matrix, _Matrix]:
    places = (np.arange(cells * upsampling) - cells * upsampling // 2) / upsampling
    right = _to_columns(places, cells)
    # Of the highest frequency only the cosine is known: between cells it would ring.
    right[-2:] = 0
    return np.asarray(_waves(places, cells) / cells, np.float32), right


def _waves(places: npt.NDArray[np.integer] | Array, cells: int) -> Array:
    """Cosines and then sines of all frequencies at some places, (places, cells)."""
    angles = 2 * np.pi / cells * np.outer(places, frequencies(cells)[: cells // 2 + 1])
    return np.hstack([np.cos(angles), np.sin(angles[:, 2:])])


def _pairs(places: npt.NDArray[np.integer] | Array, cells: int, weights: Array) -> _Matrix:
    """Matrix that takes cells of a row to real and imaginary parts, by turns, of its spectrum."""
    waves = np.exp(-2j * np.pi / cells * np.outer(places, np.arange(cells // 2 + 1)))
    return np.asarray(waves * weights, np.complex64).view(np.float32)


def _to_columns(places: npt.NDArray[np.integer] | Array, cells: int) -> _Matrix:
    """Matrix that takes such parts to values at some places; most stand for two frequencies."""
    # The half spectrum leaves out negative frequencies along x, which are the conjugates.
    counted = np.full(cells // 2 + 1, 2 / cells)
    counted[[0, -1]] = 1 / cells
    return np.ascontiguousarray(_pairs(places, cells, counted).T)
