# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Textures are smooth where they should be, textured where they should be, and seeded."""

import numpy as np
import pytest

from vehicle_pf_tracker.scenes.grounds import asphalt, concrete, foliage, grass, value_noise
from vehicle_pf_tracker.scenes.random_streams import stream

SURFACES = (asphalt, concrete, foliage, grass)


def test_value_noise_is_linear_between_its_grid_corners():
    noise = value_noise((9, 9), (4, 4), stream(0, "noise"))
    np.testing.assert_allclose(noise[0, :5], np.linspace(noise[0, 0], noise[0, 4], 5), atol=1e-12)
    np.testing.assert_allclose(noise[4:, 8], np.linspace(noise[4, 8], noise[8, 8], 5), atol=1e-12)
    assert np.abs(noise).max() <= 1


@pytest.mark.parametrize("surface", SURFACES)
def test_surfaces_have_contrast_within_the_levels(surface):
    image = surface((120, 160), stream(2, "surface"))
    assert image.shape == (120, 160, 3)
    assert image.dtype == np.float32
    assert image.min() >= 0
    assert image.max() <= 255
    assert image.std(axis=(0, 1)).min() > 3


def test_streams_do_not_depend_on_each_other():
    draws = {
        stream(seed, name, index).random()
        for seed in (0, 1)
        for name in ("a", "b")
        for index in (0, 1)
    }
    assert len(draws) == 8
    assert stream(3, "a", 2).random() == stream(3, "a", 2).random()
