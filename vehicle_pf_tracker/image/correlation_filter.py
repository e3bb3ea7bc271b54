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

"""A discriminative correlation filter that is confined to the target and learns step by step.

Li et al., "Learning spatial-temporal regularized correlation filters for visual tracking" (2018),
with a hard spatial limit as in Kiani Galoogahi et al., "Learning background-aware correlation
filters" (2017): the filter may use the target's cells only, and is trained against everything
around it. Each training step solves

    min over g:  1/2 |sum_k x_k * g_k - y|^2  +  stiffness/2 |g - g_before|^2,   g = 0 outside

for one image by a few steps of the alternating direction method of multipliers (ADMM); `x` are the
feature channels, `*` is correlation, and `y` a narrow Gaussian at the target's centre.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.gradient_cells import CellFeatures
from vehicle_pf_tracker.image.partial_fourier import PartialFourier, Spectrum, upsampled

Response: TypeAlias = npt.NDArray[np.float32]
"""Filter response by [y, x], its middle at the patch's centre; 1 is the ideal peak."""

UPSAMPLING = 2
"""Places per cell and axis at which the response is computed; its peak is a cell wide."""
_LABEL_SIGMA = 1 / 16
"""Standard deviation of the ideal response, of the target's side; the value of STRCF."""
_FIRST_STEPS, _FIRST_GROWTH = 8, 3.0
"""ADMM steps on the first image, which all later ones build on, and growth of the penalty."""
_STEPS, _GROWTH = 2, 5.0
"""The same on later images: STRCF shows that two steps from the filter before are enough."""


@dataclass(frozen=True, slots=True, eq=False)
class FilterWeights:
    """A trained filter: what remains when it is kept for later.

    Attributes
    ----------
    cells : (channels, n, n) array of float32
        The weights, zero outside the target.
    target : (channels, rows, columns) array of float32
        Those of the target's cells.
    spectrum : (channels, n, n // 2 + 1) array of complex64
        Their half spectrum.
    """

    cells: CellFeatures
    target: CellFeatures
    spectrum: Spectrum


class CorrelationFilter:
    """Finds a target of a given canonical size among the cells around it.

    Parameters
    ----------
    cells : int
        Cells along each side of the patches it sees; even.
    target : (2,) array
        Width and height of the target in cells.
    penalty : float
        First ADMM penalty: the larger, the smoother the filter and the less a step changes it.
    """

    def __init__(self, cells: int, target: Array, penalty: float) -> None:
        self.penalty = penalty
        offsets = np.arange(cells) - cells // 2
        sigma = _LABEL_SIGMA * float(np.sqrt(target.prod()))
        label = np.exp(-0.5 * (offsets[:, np.newaxis] ** 2 + offsets**2) / sigma**2)
        self._label = half_spectrum(np.fft.ifftshift(label).astype(np.float32))
        from_middle = np.abs(np.arange(cells) - (cells - 1) / 2)
        inside = (from_middle[:, np.newaxis] <= target[1] / 2) & (from_middle <= target[0] / 2)
        rows, columns = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
        self._rows = slice(int(rows[0]), int(rows[-1]) + 1)
        self._columns = slice(int(columns[0]), int(columns[-1]) + 1)
        self._target = PartialFourier(cells, self._rows, self._columns)
        window = np.hanning(cells + 2)[1:-1]
        self._faded = PartialFourier(cells, slice(cells), slice(cells), window)
        self._window = np.outer(window, window).astype(np.float32)
        self._down = (-2j * np.pi * np.fft.fftfreq(cells))[:, np.newaxis]
        self._right = -2j * np.pi * np.fft.rfftfreq(cells)
        self._cells = cells
        self.weights: FilterWeights | None = None

    def spectrum(self, features: CellFeatures) -> Spectrum:
        """Half spectrum of cells (channels, n, n), faded out towards the border."""
        return self._faded.spectrum_of(features)

    def shifted(self, spectrum: Spectrum, x: float, y: float) -> Spectrum:
        """Spectrum of the same cells moved by (x, y) cells, circularly."""
        phase = np.exp(self._down * y) * np.exp(self._right * x)
        return np.asarray(spectrum * phase.astype(np.complex64))

    def train(self, spectrum: Spectrum, stiffness: float) -> None:
        """Learn from one image in whose middle the target is.

        Parameters
        ----------
        spectrum : (channels, n, n // 2 + 1) array
            Of the image's cells.
        stiffness : float
            Resistance against change; the first image is learnt without any.
        """
        if self.weights is None:
            self.weights = self._solve(spectrum, None, 0.0, _FIRST_STEPS, _FIRST_GROWTH)
        else:
            before = self.weights.spectrum
            self.weights = self._solve(spectrum, before, stiffness, _STEPS, _GROWTH)

    def _solve(
        self, spectrum: Spectrum, before: Spectrum | None, stiffness: float, steps: int,
        growth: float,
    ) -> FilterWeights:  # fmt: skip
        places = self._cells**2
        squares = np.square(spectrum.view(np.float32)).sum(axis=0)
        power = squares[:, 0::2] + squares[:, 1::2]
        conjugate = spectrum.conj()
        wanted = spectrum * (self._label * np.float32(1 / places))
        free = np.empty_like(spectrum)
        if before is not None:
            wanted += np.multiply(before, np.float32(stiffness), out=free)
        # The multiplier is kept divided by the penalty (scaled ADMM). Whole spectra are written
        # over: new memory for each of them would take longer than the arithmetic.
        right, multiplier = wanted.copy(), np.zeros_like(spectrum)
        penalty = self.penalty
        for step in range(steps):
            total = np.float32(penalty + stiffness)
            # (x x^H + places * total) f = places * right, by Sherman and Morrison.
            np.multiply(conjugate, right, out=free)
            share = free.sum(axis=0) / (power + places * total)
            np.multiply(spectrum, share, out=free)
            np.subtract(right, free, out=free)
            free *= 1 / total  # not divided: numpy divides complex numbers ten times slower
            multiplier += free
            cells = self._target.cells_of(multiplier)
            confined = self._target.spectrum_of(cells)
            if step < steps - 1:
                multiplier -= confined
                multiplier *= np.float32(1 / growth)
                penalty *= growth
                np.subtract(confined, multiplier, out=right)
                right *= np.float32(penalty)
                right += wanted
        weights = np.zeros((len(cells), self._cells, self._cells), np.float32)
        weights[:, self._rows, self._columns] = cells
        return FilterWeights(weights, cells, confined)

    def respond(self, spectrum: Spectrum) -> Response:
        """Respond to cells (half spectrum), at `UPSAMPLING` places per cell."""
        assert self.weights is not None, "train the filter first"
        return _correlated(spectrum, self.weights.spectrum)

    @property
    def extent(self) -> int:
        """Cells along the longer side of the target; even."""
        assert self.weights is not None, "train the filter first"
        return max(int(side) for side in self.weights.target.shape[1:])

    def respond_in_middle(self, features: CellFeatures) -> float:
        """Respond to the cells (channels, m, m) of a smaller patch at its centre only; m even."""
        assert self.weights is not None, "train the filter first"
        margin = (self._cells - features.shape[1]) // 2
        rows = slice(self._rows.start - margin, self._rows.stop - margin)
        columns = slice(self._columns.start - margin, self._columns.stop - margin)
        seen = features[:, rows, columns] * self._window[self._rows, self._columns]
        return float(np.vdot(seen, self.weights.target))

    def respond_wide(self, features: CellFeatures) -> Response:
        """Respond to the cells (channels, m, m) of a larger patch, m even and above n."""
        assert self.weights is not None, "train the filter first"
        size = features.shape[1]
        margin = (size - self._cells) // 2
        padded = np.pad(self.weights.cells, ((0, 0), (margin, margin), (margin, margin)))
        return _correlated(half_spectrum(features), half_spectrum(padded))


def half_spectrum(cells: npt.NDArray[np.float32]) -> Spectrum:
    """Fourier transform over the last two axes."""
    return np.asarray(np.fft.rfft2(cells), np.complex64)


def cells_of(spectrum: Spectrum, size: int) -> CellFeatures:
    """Inverse Fourier transform to (..., size, size)."""
    return np.asarray(np.fft.irfft2(spectrum, s=(size, size)), np.float32)


def _correlated(spectrum: Spectrum, weights: Spectrum) -> Response:
    """Correlate and sum over channels."""
    return upsampled((spectrum * weights.conj()).sum(axis=0), UPSAMPLING)
