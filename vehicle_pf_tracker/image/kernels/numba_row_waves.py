# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Exchange of spectra and waves along y, compiled; `image.correlation.row_waves` says what it is.

Numpy goes through the rows four times, in pieces of a few hundred numbers; here it is once.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.image.correlation.gradient_cells import CellFeatures
from vehicle_pf_tracker.image.correlation.row_waves import RowWaves, Spectrum
from vehicle_pf_tracker.image.kernels.toolchain.kernel import compiled

_PAIRS = "float32[:, :, ::1]"
"""Real and imaginary parts by turns along x, (channels, n, n + 2)."""


@compiled(_PAIRS, _PAIRS)
def _of(pairs: CellFeatures) -> CellFeatures:
    channels, rows, width = pairs.shape
    # Numba does not check indices: of fewer rows the second would be read beyond the end.
    if rows < 2:
        raise IndexError("a spectrum has at least two rows")
    half = rows // 2
    waves = np.empty((channels, rows, width), np.float32)
    for c in range(channels):
        for x in range(width):
            waves[c, 0, x] = pairs[c, 0, x]
            waves[c, 1, x] = pairs[c, 1, x]
        for y in range(2, half + 1):
            low = pairs[c, y]
            high = pairs[c, y + half - 1]
            cosines = waves[c, y]
            sines = waves[c, y + half - 1]
            for x in range(0, width - 1, 2):
                cosines[x] = low[x] + high[x]
                cosines[x + 1] = low[x + 1] + high[x + 1]
                # The difference times i: a quarter turn.
                sines[x] = high[x + 1] - low[x + 1]
                sines[x + 1] = low[x] - high[x]
    return waves


@compiled(_PAIRS, _PAIRS)
def _joined(waves: CellFeatures) -> CellFeatures:
    channels, rows, width = waves.shape
    half = rows // 2
    for c in range(channels):
        for y in range(2, half + 1):
            low = waves[c, y]
            high = waves[c, y + half - 1]
            for x in range(0, width - 1, 2):
                # The sines times i: a quarter turn.
                sine = -high[x + 1]
                sine_turned = high[x]
                cosine = low[x]
                cosine_turned = low[x + 1]
                low[x] = cosine - sine
                low[x + 1] = cosine_turned - sine_turned
                high[x] = cosine + sine
                high[x + 1] = cosine_turned + sine_turned
    return waves


class CompiledRowWaves(RowWaves):
    """The same of whole stacks of channels by compiled code."""

    def of(self, spectrum: Spectrum) -> CellFeatures:
        """See `RowWaves.of`."""
        waves: CellFeatures = _of(spectrum.view(np.float32))
        return waves

    def joined(self, waves: CellFeatures) -> Spectrum:
        """See `RowWaves.joined`."""
        joined: CellFeatures = _joined(waves)
        return joined.view(np.complex64)
