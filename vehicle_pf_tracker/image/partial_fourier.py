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
from vehicle_pf_tracker.image.gradient_cells import CellFeatures

Spectrum: TypeAlias = npt.NDArray[np.complex64]
"""Half spectrum of cells, (channels, n, n // 2 + 1)."""
_Matrix: TypeAlias = npt.NDArray[np.float32]


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
        down = 2j * np.pi * np.outer(np.arange(cells)[rows], np.fft.fftfreq(cells))
        right = 2j * np.pi * np.outer(np.fft.rfftfreq(cells), np.arange(cells)[columns])
        self._to_rows = (np.exp(down) / cells).astype(np.complex64)
        weights = np.ones(cells) if window is None else window
        from_rows = np.exp(-down).T * weights[rows]
        from_columns = np.exp(-right).T * weights[columns, np.newaxis]
        self._from_rows = np.ascontiguousarray(from_rows, np.complex64)
        self._to_columns = _real_part_of(np.exp(right), cells)
        self._from_columns = _as_pairs(np.ascontiguousarray(from_columns, np.complex64))

    def cells_of(self, spectrum: Spectrum) -> CellFeatures:
        """Cells of the part, (channels, rows, columns)."""
        return np.asarray(_as_pairs(self._to_rows @ spectrum) @ self._to_columns)

    def spectrum_of(self, cells: CellFeatures) -> Spectrum:
        """Half spectrum of the square from the cells of the part."""
        rows = (cells @ self._from_columns).view(np.complex64)
        return np.asarray(self._from_rows @ rows)


def upsampled(spectrum: Spectrum, upsampling: int) -> _Matrix:
    """Inverse transform of a half spectrum (n, n // 2 + 1), `upsampling` places per cell and axis.

    Zero is in the middle. The highest frequency along x, which has no phase, is left out.
    """
    down, right = _fine_transforms(len(spectrum), upsampling)
    return np.asarray(_as_pairs(down @ spectrum) @ right)


@functools.cache
def _fine_transforms(cells: int, upsampling: int) -> tuple[Spectrum, _Matrix]:
    places = (np.arange(cells * upsampling) - cells * upsampling // 2) / upsampling
    down = np.exp(2j * np.pi * np.outer(places, np.fft.fftfreq(cells))) / cells
    right = np.exp(2j * np.pi * np.outer(np.fft.rfftfreq(cells), places))
    right[cells // 2] = 0
    return down.astype(np.complex64), _real_part_of(right, cells)


def _real_part_of(waves: npt.NDArray[np.complex128], cells: int) -> _Matrix:
    """Matrix that takes pairs of real and imaginary parts of a half spectrum to real values."""
    counted = np.full(len(waves), 2.0)  # once for itself, once for the frequency below zero
    counted[[0, -1]] = 1.0
    waves = waves * counted[:, np.newaxis] / cells
    pairs = np.stack([waves.real, -waves.imag], axis=1)
    return np.ascontiguousarray(pairs.reshape(2 * len(waves), -1), np.float32)


def _as_pairs(values: Spectrum) -> _Matrix:
    """View complex numbers (..., n) as pairs (..., 2 n) of real and imaginary parts."""
    return values.view(np.float32)
