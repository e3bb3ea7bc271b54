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

"""Products of spectra over all channels: the inner loops of a correlation filter, in numpy.

The kernels in numba do the same in one pass over memory; see `image.kernels`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.partial_fourier import Spectrum, complex_spectrum, real_spectrum


@dataclass(frozen=True, slots=True, eq=False)
class FilterProblem:
    """Least squares that a filter is to solve, and where its unconfined solution is drawn to.

    Attributes
    ----------
    spectrum : (n, channels, 2, n // 2 + 1) array
        Of the image's cells.
    before : array of the same shape
        Of the filter before; zero where `stiffness` is.
    label : (n // 2 + 1, n // 2 + 1) array of float32
        Spectrum of the ideal response, which is even and therefore real, over the places.
    stiffness : float
        Resistance against change.
    """

    spectrum: Spectrum
    before: Spectrum
    label: npt.NDArray[np.float32]
    stiffness: float


@dataclass(frozen=True, slots=True)
class Penalty:
    """Weight of the confinement in one step of ADMM, and what it grew by since the last step."""

    weight: float
    growth: float


class SpectralKernels(Protocol):
    """Products of spectra; `numpy` here, or compiled."""

    def take_filter_step(
        self, problem: FilterProblem, penalty: Penalty, multiplier: Spectrum, confined: Spectrum
    ) -> None:
        """Solve without the confinement; see `take_filter_step`."""
        ...

    def correlated(self, spectrum: Spectrum, weights: Spectrum) -> Spectrum:
        """Correlate and sum over channels; see `correlated`."""
        ...

    def shifted(self, spectrum: Spectrum, x: float, y: float) -> Spectrum:
        """Move cells; see `shifted`."""
        ...


def take_filter_step(
    problem: FilterProblem, penalty: Penalty, multiplier: Spectrum, confined: Spectrum
) -> None:
    """Solve without the confinement, near to the confined filter.

    Parameters
    ----------
    problem : FilterProblem
        What is to be solved.
    penalty : Penalty
        Of this step.
    multiplier : array like the spectrum
        The multiplier with the solution of the step before added, divided by that step's penalty;
        here it becomes that of this step (scaled ADMM).
    confined : array like the spectrum
        That sum of the step before, confined to the target.
    """
    multiplier -= confined
    multiplier *= np.float32(1 / penalty.growth)
    half = len(multiplier) // 2
    label = np.concatenate([problem.label, problem.label[1:half]])[:, np.newaxis, np.newaxis]
    right = problem.spectrum * label + problem.before * np.float32(problem.stiffness)
    right += (confined - multiplier) * np.float32(penalty.weight)
    # (x x^H + places * total) f = places * right, by Sherman and Morrison.
    image, total = complex_spectrum(problem.spectrum), penalty.weight + problem.stiffness
    power = np.square(image.real).sum(axis=1) + np.square(image.imag).sum(axis=1)
    share = (image.conj() * complex_spectrum(right)).sum(axis=1)
    share /= power + np.float32(len(image) ** 2 * total)
    right -= real_spectrum(image * share[:, np.newaxis])
    right *= np.float32(1 / total)
    multiplier += right


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
