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

"""Products of spectra, compiled; see `image.spectra` for what they are.

A frequency k along y and its negative are made of the same cosines and sines: cosine - i sine is
the one, cosine + i sine the other ("low" and "high" here). Loops run over such pairs of rows, and
along x, where they are vectorised. Frequencies 0 and n / 2 have no sine, and go first, while the
right side of the sines is zero.

Climbing on a map, compiled; see `image.correlation_filter` for what it is.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numba import float32, float64, intp, types, void

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation_filter import Places
from vehicle_pf_tracker.image.kernels.numba_jit import compiled, inlined
from vehicle_pf_tracker.image.spectra import FilterProblem, Penalty, Spectrum

_Rows: TypeAlias = npt.NDArray[np.float32]
_Pair: TypeAlias = tuple[Spectrum, Spectrum]

_SPECTRUM = types.Array(float32, 4, "C")
_PAIR = types.UniTuple(_SPECTRUM, 2)
_LABEL = types.Array(float32, 2, "C")


@inlined
def _frequency(index: int, half: int) -> tuple[int, int]:
    """Frequency by its turn, 0, n / 2, 1, 2, ..., and number of rows that it has."""
    if index < 2:
        return index * half, 1
    return index - 1, 2


@inlined
def _draw(
    images: _Pair, label: _Rows, sums: _Pair, weights: tuple[float, float, float],
    place: tuple[int, int], right: Spectrum,
) -> None:  # fmt: skip
    """Shrink a row of the multiplier, and write that of the right side."""
    (spectrum, before), (multiplier, confined) = images, sums
    stiffness, weight, shrunk = weights
    k, part = place
    cells, channels, _, width = spectrum.shape
    row = k + part * (cells // 2)
    for c in range(channels):
        for plane in range(2):
            for x in range(width):
                drawn = confined[row, c, plane, x]
                held = (multiplier[row, c, plane, x] - drawn) * shrunk
                multiplier[row, c, plane, x] = held
                wanted = spectrum[row, c, plane, x] * label[k, x]
                wanted += before[row, c, plane, x] * stiffness
                right[part, c, plane, x] = wanted + (drawn - held) * weight


@inlined
def _share(
    spectrum: Spectrum, rows: tuple[int, int], right: Spectrum, loading: float, share: _Rows
) -> None:
    """Write the image's shares in the solution: low real, low imaginary, high, (4, width)."""
    channels, width = spectrum.shape[1], spectrum.shape[3]
    k, row = rows
    sine = np.float32(k != row)
    power = np.zeros((2, width), np.float32)
    share[:] = 0
    for c in range(channels):
        for x in range(width):
            a, b = spectrum[k, c, 0, x], spectrum[k, c, 1, x]
            p, q = sine * spectrum[row, c, 0, x], sine * spectrum[row, c, 1, x]
            u, v = right[0, c, 0, x], right[0, c, 1, x]
            s, t = right[1, c, 0, x], right[1, c, 1, x]
            low_re, low_im, high_re, high_im = a + q, b - p, a - q, b + p
            power[0, x] += low_re * low_re + low_im * low_im
            power[1, x] += high_re * high_re + high_im * high_im
            share[0, x] += low_re * (u + t) + low_im * (v - s)
            share[1, x] += low_re * (v - s) - low_im * (u + t)
            share[2, x] += high_re * (u - t) + high_im * (v + s)
            share[3, x] += high_re * (v + s) - high_im * (u - t)
    for x in range(width):
        for part in range(4):
            share[part, x] /= power[part // 2, x] + loading


@inlined
def _add(
    spectrum: Spectrum, rows: tuple[int, int], right: Spectrum, share: _Rows, inverse: float,
    multiplier: Spectrum,
) -> None:  # fmt: skip
    """Add the solution to the multiplier."""
    channels, width = spectrum.shape[1], spectrum.shape[3]
    k, row = rows
    sine, half = np.float32(k != row), np.float32(0.5)
    for c in range(channels):
        for x in range(width):
            a, b = spectrum[k, c, 0, x], spectrum[k, c, 1, x]
            p, q = sine * spectrum[row, c, 0, x], sine * spectrum[row, c, 1, x]
            low_re, low_im, high_re, high_im = a + q, b - p, a - q, b + p
            l_re = low_re * share[0, x] - low_im * share[1, x]
            l_im = low_re * share[1, x] + low_im * share[0, x]
            h_re = high_re * share[2, x] - high_im * share[3, x]
            h_im = high_re * share[3, x] + high_im * share[2, x]
            multiplier[k, c, 0, x] += (right[0, c, 0, x] - half * (l_re + h_re)) * inverse
            multiplier[k, c, 1, x] += (right[0, c, 1, x] - half * (l_im + h_im)) * inverse
            odd_re = (right[1, c, 0, x] - half * (h_im - l_im)) * inverse
            odd_im = (right[1, c, 1, x] - half * (l_re - h_re)) * inverse
            multiplier[row, c, 0, x] += sine * odd_re
            multiplier[row, c, 1, x] += sine * odd_im


@compiled(void(_PAIR, _LABEL, _PAIR, types.UniTuple(float32, 3)))
def _take_filter_step(
    images: _Pair, label: _Rows, sums: _Pair, weights: tuple[float, float, float]
) -> None:
    spectrum, (stiffness, weight, growth) = images[0], weights
    cells, channels, _, width = spectrum.shape
    half = cells // 2
    one = np.float32(1)
    total, shrunk = weight + stiffness, one / growth
    right = np.zeros((2, channels, 2, width), np.float32)
    share = np.empty((4, width), np.float32)
    for index in range(half + 1):
        k, parts = _frequency(index, half)
        for part in range(parts):
            _draw(images, label, sums, (stiffness, weight, shrunk), (k, part), right)
        rows = k, k + (parts - 1) * half
        _share(spectrum, rows, right, np.float32(cells * cells) * total, share)
        _add(spectrum, rows, right, share, one / total, sums[0])


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


@inlined
def _rotate(spectrum: Spectrum, row: int, real: _Rows, imaginary: _Rows, moved: Spectrum) -> None:
    """Multiply a row by complex numbers along x."""
    for c in range(spectrum.shape[1]):
        for x in range(spectrum.shape[3]):
            a, b = spectrum[row, c, 0, x], spectrum[row, c, 1, x]
            moved[row, c, 0, x] = a * real[x] - b * imaginary[x]
            moved[row, c, 1, x] = a * imaginary[x] + b * real[x]


@compiled(_SPECTRUM(_SPECTRUM, float64, float64))
def shifted(spectrum: Spectrum, x: float, y: float) -> Spectrum:
    """See `spectra.shifted`."""
    cells, channels, _, width = spectrum.shape
    half = cells // 2
    moved = np.empty_like(spectrum)
    angles = -2 * np.pi / cells * np.arange(width)
    real, imaginary = np.cos(angles * x), np.sin(angles * x)
    real, imaginary = real.astype(np.float32), imaginary.astype(np.float32)
    for row in range(cells):
        _rotate(spectrum, row, real, imaginary, moved)
    # Of the rows without a sine, frequency 0 stays.
    turn = np.pi * y
    real[:], imaginary[:] = np.float32(np.cos(turn)), np.float32(np.sin(turn))
    _rotate(moved, half, real, imaginary, moved)
    for k in range(1, half):
        cosine, sine = np.float32(np.cos(angles[k] * y)), np.float32(np.sin(angles[k] * y))
        for c in range(channels):
            for plane in range(2):
                for x_ in range(width):
                    even, odd = moved[k, c, plane, x_], moved[k + half, c, plane, x_]
                    moved[k, c, plane, x_] = even * cosine + odd * sine
                    moved[k + half, c, plane, x_] = odd * cosine - even * sine
    return moved


def take_filter_step(
    problem: FilterProblem, penalty: Penalty, multiplier: Spectrum, confined: Spectrum
) -> None:
    """See `spectra.take_filter_step`."""
    weights = problem.stiffness, penalty.weight, penalty.growth
    images, sums = (problem.spectrum, problem.before), (multiplier, confined)
    _take_filter_step(images, problem.label, sums, weights)


_MAP = types.Array(float64, 2, "C", readonly=True)
_PLACES = types.Array(intp, 2, "C")


@compiled(types.Tuple([_PLACES, types.Array(float64, 1, "C")])(_MAP, _PLACES, _MAP))
def climbed(values: Array, places: Places, costs: Array) -> tuple[Places, Array]:
    """See `correlation_filter.climbed`."""
    reach, last = len(costs) // 2, len(values) - 1
    moves, gains = np.zeros_like(places), np.empty(len(places))
    for i in range(len(places)):
        best = -np.inf
        for dy in range(-reach, reach + 1):
            row = min(max(places[i, 1] + dy, 0), last)
            for dx in range(-reach, reach + 1):
                column = min(max(places[i, 0] + dx, 0), last)
                gain = values[row, column] - costs[dy + reach, dx + reach]
                if gain > best:
                    best, moves[i, 0], moves[i, 1] = gain, dx, dy
        gains[i] = best
    return moves, gains
