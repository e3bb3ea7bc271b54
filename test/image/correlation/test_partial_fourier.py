# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Partial Fourier transforms against whole ones."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation.spectra import PartialFourier, frequencies, upsampled

SIDE = 16
ROWS, COLUMNS = slice(5, 11), slice(3, 13)


def cells():
    values = np.zeros((3, SIDE, SIDE), np.float32)
    values[:, ROWS, COLUMNS] = np.random.default_rng(0).normal(size=(3, 6, 10))
    return values


def transformed(whole):
    spectrum = np.fft.rfft2(whole)
    return spectrum[..., frequencies(spectrum.shape[-2]), :].astype(np.complex64)


def test_spectrum_by_hand():
    """Waves 1 + cos y + 3 sin 2 y + 5 cos x sin y over a period of 8: halves and quarters of 64."""
    y, x = np.mgrid[:8, :8] * np.pi / 4
    waves = 1 + np.cos(y) + 3 * np.sin(2 * y) + 5 * np.cos(x) * np.sin(y)
    found = PartialFourier(8, slice(8), slice(8)).spectrum_of(waves[np.newaxis].astype(np.float32))
    rows = frequencies(8).tolist()
    expected = np.zeros((1, 8, 5), complex)
    expected[0, rows.index(0), 0] = 64
    for sign in (1, -1):
        expected[0, rows.index(sign), :2] = 32, -sign * 5j * 16
        expected[0, rows.index(2 * sign), 0] = -sign * 3j * 32
    assert found == pytest.approx(expected, abs=1e-4)


def test_cells_of_a_part_have_the_spectrum_of_the_whole_and_come_back():
    part = PartialFourier(SIDE, ROWS, COLUMNS)
    spectrum = part.spectrum_of(cells()[:, ROWS, COLUMNS])
    assert spectrum.dtype == np.complex64
    assert spectrum.shape == (3, SIDE, SIDE // 2 + 1)
    assert spectrum == pytest.approx(transformed(cells()), abs=1e-5)
    assert part.cells_of(spectrum) == pytest.approx(cells()[:, ROWS, COLUMNS], abs=1e-6)


def test_a_wave_is_interpolated_between_cells():
    """A wave of 3 and -2 periods has its crest in the middle, and is known everywhere."""
    places = np.arange(SIDE)
    wave = np.cos(2 * np.pi * (3 * places - 2 * places[:, np.newaxis]) / SIDE)
    fine = upsampled(transformed(wave), 4)
    places = np.arange(-SIDE // 2, SIDE // 2, 0.25)
    expected = np.cos(2 * np.pi * (3 * places - 2 * places[:, np.newaxis]) / SIDE)
    assert fine == pytest.approx(expected, abs=1e-5)
