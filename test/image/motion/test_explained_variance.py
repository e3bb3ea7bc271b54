# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""How well flow explains an image: by the correlation with where it leads in an earlier one."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.explained_variance import explained_variance

CELLS = np.array([[2, 3], [4, 3]])
"""Columns 8 to 23, rows 12 to 23."""


def noise(seed=0):
    return np.random.default_rng(seed).integers(50, 150, (40, 40)).astype(np.uint8)


def along(dx, dy):
    """Flow that leads from every pixel as far as that."""
    return np.tile(np.array([dx, dy], np.float32), (40, 40, 1))


def test_an_image_that_has_moved_is_explained_by_flow_to_where_it_was():
    before = noise()
    image = np.roll(before, (2, -3), axis=(0, 1))
    assert explained_variance(image, before, along(3, -2), CELLS) == pytest.approx(1.0)
    assert explained_variance(image, before, along(0, 0), CELLS) < 0.1


def test_a_change_of_light_or_contrast_is_no_error():
    before = noise()
    brighter = (before // 2 * 3 + 20).astype(np.uint8)
    even = before // 2 * 2
    assert explained_variance(brighter, even, along(0, 0), CELLS) == pytest.approx(1.0)


def test_only_the_block_counts():
    before = noise()
    image = noise(1)
    image[12:24, 8:24] = before[12:24, 8:24]
    assert explained_variance(image, before, along(0, 0), CELLS) == pytest.approx(1.0)


def test_it_is_the_square_of_the_correlation():
    """Of 8 columns four are light, and in the earlier image five, four of them the same ones.

    Their correlation is (4 * 3 - 1 * 0) / sqrt(4 * 4 * 5 * 3), and its square 144 / 240.
    """
    image, before = np.zeros((2, 8, 8), np.uint8)
    image[:, 4:] = 100
    before[:, 3:] = 100
    block = np.array([[0, 0], [2, 2]])
    flow = np.zeros((8, 8, 2), np.float32)
    assert explained_variance(image, before, flow, block) == pytest.approx(0.6)


def test_what_is_reversed_or_plain_explains_nothing():
    before = noise()
    plain = np.full_like(before, 90)
    still = along(0, 0)
    assert explained_variance(255 - before, before, still, CELLS) == 0.0
    assert explained_variance(before, plain, still, CELLS) == 0.0
    assert explained_variance(plain, before, still, CELLS) == 0.0


def test_flow_beyond_the_border_leads_to_its_last_pixels():
    rows = np.arange(0, 160, 4, dtype=np.uint8)[:, np.newaxis]
    before = np.tile(rows, (1, 40))
    assert explained_variance(before, before, along(100, 0), CELLS) == pytest.approx(1.0)
