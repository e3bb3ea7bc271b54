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

"""Correlation of spectra, compiled; see `image.spectra` for what they are.

A frequency k along y and its negative are made of the same cosines and sines: cosine - i sine is
the one, cosine + i sine the other. Loops run over such pairs of rows, and along x, where they are
vectorised. Frequencies 0 and n / 2 have no sine.
"""

from __future__ import annotations

import numpy as np
from numba import float32, types

from vehicle_pf_tracker.image.kernels.numba_jit import compiled
from vehicle_pf_tracker.image.spectra import Spectrum

_SPECTRUM = types.Array(float32, 4, "C")


@compiled(_SPECTRUM(_SPECTRUM, _SPECTRUM))
def correlated(spectrum: Spectrum, weights: Spectrum) -> Spectrum:
    """See `spectra.correlated`."""
    cells, channels, _, width = spectrum.shape
    half = cells // 2
    product = np.zeros((cells, 1, 2, width), np.float32)
    for k in range(half + 1):
        real, imaginary = product[k, 0, 0], product[k, 0, 1]
        for c in range(channels):
            for x in range(width):
                a, b = spectrum[k, c, 0, x], spectrum[k, c, 1, x]
                u, v = weights[k, c, 0, x], weights[k, c, 1, x]
                real[x] += a * u + b * v
                imaginary[x] += b * u - a * v
    for k in range(1, half):
        even, odd = product[k, 0], product[k + half, 0]
        for c in range(channels):
            for x in range(width):
                # (C - i S) (U - i V)* for k, and (C + i S) (U + i V)* for its negative.
                a, b = spectrum[k, c, 0, x], spectrum[k, c, 1, x]
                p, q = spectrum[k + half, c, 0, x], spectrum[k + half, c, 1, x]
                u, v = weights[k, c, 0, x], weights[k, c, 1, x]
                s, t = weights[k + half, c, 0, x], weights[k + half, c, 1, x]
                even[0, x] += p * s + q * t
                even[1, x] += q * s - p * t
                odd[0, x] += p * u + q * v - a * s - b * t
                odd[1, x] += q * u - p * v - b * s + a * t
    return product
