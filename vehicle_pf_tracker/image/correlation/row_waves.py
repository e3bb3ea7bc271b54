# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rows of half spectra as coefficients of cosines and sines along y, and back.

A row of frequency f and that of -f are the sum and the difference of both; `spectra.frequencies`
says which rows these are.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.image.correlation.gradient_cells import CellFeatures

Spectrum: TypeAlias = npt.NDArray[np.complex64]
"""Half spectrum of cells, (channels, n, n // 2 + 1); its rows have the `spectra.frequencies`.

Channels come first: a sum over them adds whole spectra. On the way to it and back stand the
coefficients of cosines and sines along y, as matrix products with real numbers take half the time
of those with complex ones.
"""


class RowWaves:
    """Exchange of the two forms by numpy; a subclass does the same faster, to the same bits."""

    def of(self, spectrum: Spectrum) -> CellFeatures:
        """Coefficients (..., n, n + 2), real and imaginary parts by turns along x."""
        half = spectrum.shape[-1] - 1
        coefficients = np.empty(spectrum.shape, np.complex64)
        low = spectrum[..., 2 : half + 1, :]
        high = spectrum[..., half + 1 :, :]
        # Written in place, once each: a copy of all would cost as much as the sums.
        coefficients[..., :2, :] = spectrum[..., :2, :]
        np.add(low, high, out=coefficients[..., 2 : half + 1, :])
        sines = np.subtract(low, high, out=coefficients[..., half + 1 :, :])
        sines *= np.complex64(1j)
        return np.asarray(coefficients.view(np.float32))

    def joined(self, waves: CellFeatures) -> Spectrum:
        """Half spectra of real images' coefficients (channels, n, n + 2), in place of them."""
        spectrum = waves.view(np.complex64)
        half = spectrum.shape[-1] - 1
        cosines = spectrum[:, 2 : half + 1]
        sines = 1j * spectrum[:, half + 1 :]
        np.add(cosines, sines, out=spectrum[:, half + 1 :])
        cosines -= sines
        return spectrum
