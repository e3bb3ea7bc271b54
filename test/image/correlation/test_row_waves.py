# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rows of spectra become cosines and sines and back, by numpy and compiled to the same bits."""

from __future__ import annotations

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation.row_waves import RowWaves, Spectrum
from vehicle_pf_tracker.image.kernels.interface import load_kernels


def spectra(channels: int, cells: int) -> Spectrum:
    shape = (2, channels, cells, cells // 2 + 1)
    real, imaginary = np.random.default_rng(5).normal(size=shape)
    return np.asarray(real + 1j * imaginary, np.complex64)


def test_rows_of_two_frequencies_are_their_sum_and_difference() -> None:
    spectrum = spectra(1, 4)[0]
    waves = RowWaves().of(spectrum).view(np.complex64)
    # Rows of 4 cells: frequencies 0, -2, 1 and -1.
    assert waves[:2] == pytest.approx(spectrum[:2])
    assert waves[2] == pytest.approx(spectrum[2] + spectrum[3])
    assert waves[3] == pytest.approx(1j * (spectrum[2] - spectrum[3]))


def test_joined_waves_are_twice_the_spectrum() -> None:
    spectrum = spectra(3, 8)
    joined = RowWaves().joined(RowWaves().of(spectrum))
    # Those of frequency f and -f; the transforms have the factor that makes it once.
    assert joined[:, :2] == pytest.approx(spectrum[:, :2])
    assert joined[:, 2:5] == pytest.approx(2 * spectrum[:, 2:5], abs=1e-5)
    assert joined[:, 5:] == pytest.approx(2 * spectrum[:, 5:], abs=1e-5)


@pytest.mark.parametrize(("channels", "cells"), [(34, 32), (34, 64), (1, 2), (3, 6)])
def test_compiled_waves_have_the_same_bits(channels: int, cells: int) -> None:
    pytest.importorskip("numba", reason="numba is not installed")
    compiled = load_kernels("numba").row_waves
    spectrum = spectra(channels, cells)
    waves = RowWaves().of(spectrum)
    np.testing.assert_array_equal(compiled.of(spectrum), waves)
    np.testing.assert_array_equal(compiled.joined(waves.copy()), RowWaves().joined(waves.copy()))
