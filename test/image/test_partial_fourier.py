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

"""Partial Fourier transforms against whole ones."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.partial_fourier import PartialFourier, upsampled

SIDE = 16
ROWS, COLUMNS = slice(5, 11), slice(3, 13)


def cells():
    values = np.zeros((3, SIDE, SIDE), np.float32)
    values[:, ROWS, COLUMNS] = np.random.default_rng(0).normal(size=(3, 6, 10))
    return values


def test_cells_of_a_part_have_the_spectrum_of_the_whole():
    part = PartialFourier(SIDE, ROWS, COLUMNS)
    spectrum = part.spectrum_of(cells()[:, ROWS, COLUMNS])
    assert spectrum.dtype == np.complex64
    assert spectrum == pytest.approx(np.fft.rfft2(cells()), abs=1e-5)


def test_a_spectrum_gives_the_cells_of_the_part():
    whole = np.random.default_rng(1).normal(size=(3, SIDE, SIDE))
    part = PartialFourier(SIDE, ROWS, COLUMNS)
    found = part.cells_of(np.fft.rfft2(whole).astype(np.complex64))
    assert found.dtype == np.float32
    assert found == pytest.approx(whole[:, ROWS, COLUMNS], abs=1e-5)


def test_a_wave_is_interpolated_between_cells():
    """A wave of 3 and -2 periods has its crest in the middle, and is known everywhere."""
    places = np.arange(SIDE)
    wave = np.cos(2 * np.pi * (3 * places - 2 * places[:, np.newaxis]) / SIDE)
    fine = upsampled(np.fft.rfft2(wave).astype(np.complex64), 4)
    places = np.arange(-SIDE // 2, SIDE // 2, 0.25)
    expected = np.cos(2 * np.pi * (3 * places - 2 * places[:, np.newaxis]) / SIDE)
    assert fine == pytest.approx(expected, abs=1e-5)
