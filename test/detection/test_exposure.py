# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Gain and offset of a camera whose exposure has changed."""

import numpy as np
import pytest

from vehicle_pf_tracker.detection.exposure import exposure_change

LEVELS = np.random.default_rng(0).integers(20, 180, (3, 900)).astype(float)


@pytest.mark.parametrize(("gain", "offset"), [(1.2, 0), (0.8, 0), (1.0, 25), (0.7, 30), (1.3, -12)])
def test_gain_and_offset_are_fitted_beside_vehicles(gain, offset):
    after = np.clip(gain * LEVELS + offset, 0, 255)
    after[:, :300] = 240  # a white vehicle covers a third
    curves = exposure_change(LEVELS, after)
    expected = np.clip(gain * np.arange(20, 180) + offset, 0, 255)
    assert np.abs(curves[:, 20:180] - expected).max() < 1.6


def test_each_channel_has_its_own_gain():
    gains = np.array([[1.2], [1.0], [0.85]])
    curves = exposure_change(LEVELS, np.clip(gains * LEVELS, 0, 255))
    assert curves[:, 100] == pytest.approx([120, 100, 85], abs=1)


def test_another_picture_is_no_change_of_exposure():
    other = np.random.default_rng(1).integers(20, 180, LEVELS.shape).astype(float)
    assert exposure_change(LEVELS, other) is None


def test_black_images_tell_no_exposure():
    assert exposure_change(LEVELS, np.zeros_like(LEVELS)) is None


def test_one_level_tells_a_gain_alone():
    curves = exposure_change(np.full((3, 900), 80.0), np.full((3, 900), 100.0))
    assert curves[:, [40, 80]].tolist() == [[50, 100]] * 3
