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

Products of spectra over all channels are the inner loops of a correlation filter.
"""

from __future__ import annotations

import functools
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array, product
from vehicle_pf_tracker.image.gradient_cells import CellFeatures

Spectrum: TypeAlias = npt.NDArray[np.float32]
"""Half spectrum of cells, (n, channels, 2, n // 2 + 1).

Along y it has the coefficients of cosines (n // 2 + 1 rows) and then of sines (n // 2 - 1), along x
real and imaginary parts. Matrix products with real numbers then give it from cells, and cells from
it, in half the time of those with complex ones.
"""
ComplexSpectrum: TypeAlias = npt.NDArray[np.complex64]
"""The same as complex numbers, (n, channels, n // 2 + 1)."""
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
        places = np.arange(cells)
        weights = np.ones(cells) if window is None else window
        y, x = places[rows], places[columns]
        self._from_rows = np.asarray(_waves(y, cells).T * weights[rows], np.float32)
        self._to_rows = np.asarray(_waves(y, cells) * _counted(cells), np.float32)
        self._from_columns = _from_columns(x, cells) * weights[columns, np.newaxis]
        self._from_columns = self._from_columns.astype(np.float32)
        self._to_columns = _to_columns(x, cells)

    def cells_of(self, spectrum: Spectrum) -> CellFeatures:
        """Cells of the part, (channels, rows, columns)."""
        channels = spectrum.shape[1]
        rows = product(self._to_rows, spectrum.reshape(len(spectrum), -1))
        cells = product(rows.reshape(len(rows) * channels, -1), self._to_columns)
        return np.asarray(cells.reshape(len(rows), channels, -1).transpose(1, 0, 2))

    def spectrum_of(self, cells: CellFeatures) -> Spectrum:
        """Half spectrum of the square from the cells of the part."""
        channels, count = cells.shape[:2]
        by_row = cells.transpose(1, 0, 2).reshape(count * channels, -1)
        rows = product(by_row, self._from_columns).reshape(count, -1)
        spectrum = product(self._from_rows, rows)
        return np.asarray(spectrum.reshape(len(spectrum), channels, 2, -1))


def upsampled(spectrum: Spectrum, upsampling: int) -> _Matrix:
    """Inverse transform of a half spectrum (n, 1, 2, n // 2 + 1), `upsampling` places per cell.

    Zero is in the middle. The highest frequency along x, which has no phase, is left out.
    """
    down, right = _fine_transforms(len(spectrum), upsampling)
    return product(product(down, spectrum.reshape(len(spectrum), -1)), right)


def complex_spectrum(spectrum: Spectrum) -> ComplexSpectrum:
    """Make complex numbers of the coefficients."""
    half = len(spectrum) // 2
    pairs = np.empty((*spectrum.shape[:2], spectrum.shape[3]), np.complex64)
    pairs.real, pairs.imag = spectrum[:, :, 0], spectrum[:, :, 1]
    cosines, sines = pairs[1:half], pairs[half + 1 :]
    whole = pairs.copy()
    whole[1:half] = cosines - 1j * sines
    whole[:half:-1] = cosines + 1j * sines
    return np.asarray(whole)


def real_spectrum(spectrum: ComplexSpectrum) -> Spectrum:
    """Make coefficients of complex numbers."""
    half = len(spectrum) // 2
    low, high = spectrum[1:half], spectrum[:half:-1]
    pairs = spectrum.copy()
    pairs[1:half], pairs[half + 1 :] = 0.5 * (low + high), 0.5j * (low - high)
    return np.stack([pairs.real, pairs.imag], axis=2)


@functools.cache
def _fine_transforms(cells: int, upsampling: int) -> tuple[_Matrix, _Matrix]:
    places = (np.arange(cells * upsampling) - cells * upsampling // 2) / upsampling
    down = np.asarray(_waves(places, cells) * _counted(cells), np.float32)
    right = _to_columns(places, cells).reshape(2, cells // 2 + 1, -1)
    right[:, -1] = 0
    return down, np.ascontiguousarray(right.reshape(cells + 2, -1))


def _waves(places: npt.NDArray[np.integer] | Array, cells: int) -> Array:
    """Cosines and then sines of all frequencies at some places, (places, cells)."""
    angles = 2 * np.pi / cells * np.outer(places, np.arange(cells // 2 + 1))
    return np.hstack([np.cos(angles), np.sin(angles[:, 1:-1])])


def _counted(cells: int) -> Array:
    """Weights of the coefficients in the inverse transform: most stand for two frequencies."""
    counted = np.full(cells, 2.0)
    counted[[0, cells // 2]] = 1.0
    return counted / cells


def _from_columns(places: npt.NDArray[np.integer], cells: int) -> Array:
    """Matrix that takes cells of a row to real and then imaginary parts of its half spectrum."""
    waves = np.exp(-2j * np.pi / cells * np.outer(places, np.arange(cells // 2 + 1)))
    return np.hstack([waves.real, waves.imag])


def _to_columns(places: npt.NDArray[np.integer] | Array, cells: int) -> _Matrix:
    """Matrix that takes real and imaginary parts of a half spectrum to values at some places."""
    counted = _counted(cells)[: cells // 2 + 1, np.newaxis]
    waves = np.exp(2j * np.pi / cells * np.outer(np.arange(cells // 2 + 1), places)) * counted
    return np.ascontiguousarray(np.vstack([waves.real, -waves.imag]), np.float32)


def solved(spectrum: Spectrum, right: Spectrum, total: float) -> Spectrum:
    """Solve ``(x x^H / places + total) f = right`` at each frequency, for the spectrum x."""
    # By Sherman and Morrison.
    image = complex_spectrum(spectrum)
    power = np.square(image.real).sum(axis=1) + np.square(image.imag).sum(axis=1)
    share = (image.conj() * complex_spectrum(right)).sum(axis=1)
    share /= power + np.float32(len(image) ** 2 * total)
    solution = right - real_spectrum(image * share[:, np.newaxis])
    solution *= np.float32(1 / total)
    return solution


def correlated(spectrum: Spectrum, weights: Spectrum) -> Spectrum:
    """Correlate and sum over channels, (n, 1, 2, n // 2 + 1)."""
    product = complex_spectrum(spectrum) * complex_spectrum(weights).conj()
    return real_spectrum(product.sum(axis=1, keepdims=True))


def shifted(spectrum: Spectrum, x: float, y: float) -> Spectrum:
    """Spectrum of the same cells moved by (x, y) cells, circularly."""
    cells = len(spectrum)
    down = np.exp(-2j * np.pi * y * np.fft.fftfreq(cells))[:, np.newaxis, np.newaxis]
    right = np.exp(-2j * np.pi * x * np.fft.rfftfreq(cells))
    return real_spectrum(complex_spectrum(spectrum) * (down * right).astype(np.complex64))
