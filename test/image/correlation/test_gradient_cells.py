# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cells of oriented gradients: values by hand, invariances, and agreement of the kernels."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.image.correlation.gradient_cells import (
    DIRECTIONS,
    GRADIENT_CHANNELS,
    gradient_cells,
    normalised_cells,
)
from vehicle_pf_tracker.image.kernels.interface import load_kernels

OPENCV = load_kernels("opencv")


@pytest.fixture(scope="module")
def numba():
    pytest.importorskip("numba", reason="numba is not installed")
    return load_kernels("numba")


def step(angle, side=16):
    """An edge through the middle; luminance rises in the direction `angle`, degrees from x to y."""
    y, x = np.mgrid[:side, :side] - (side - 1) / 2
    rises = np.cos(np.radians(angle)) * x + np.sin(np.radians(angle)) * y > 1e-9
    return np.where(rises, 100, 0).astype(np.uint8)


def test_a_vertical_edge_by_hand():
    """Both cells beside the edge hold 400 grey levels, 0.8 of a block's energy: truncated."""
    cells = gradient_cells(step(0))
    expected = np.zeros(GRADIENT_CHANNELS)
    expected[0] = expected[DIRECTIONS] = 0.5 * 4 * 0.2
    expected[-4:] = 0.2357 * 0.2
    for column in (1, 2):
        assert cells[:, 1, column] == pytest.approx(expected, abs=1e-6)
    assert not cells[:, :, [0, 3]].any()


def test_even_histograms_by_hand():
    """Each of 9 unsigned directions has 20: the block's energy is 4 * 9 * 400 + 16."""
    cells = normalised_cells(np.full((3, 3, DIRECTIONS), 10, np.float32))
    root = np.sqrt(4 * 9 * 400 + 16)
    assert cells[:DIRECTIONS] == pytest.approx(np.full((18, 3, 3), 2 * 10 / root))
    assert cells[DIRECTIONS:27] == pytest.approx(np.full((9, 3, 3), 2 * 20 / root))
    assert cells[27:] == pytest.approx(np.full((4, 3, 3), 0.2357 * 18 * 10 / root))


@pytest.mark.parametrize(
    ("angle", "direction"), [(0, 0), (45, 2), (135, 7), (180, 9), (225, 11), (315, 16)]
)
def test_an_edge_goes_to_the_bin_of_its_direction(angle, direction):
    middle = gradient_cells(step(angle))[:, 1:3, 1:3].sum(axis=(1, 2))
    assert middle[:DIRECTIONS].argmax() == direction
    assert middle[DIRECTIONS:27].argmax() == direction % 9


def test_a_flat_image_gives_nothing():
    assert not gradient_cells(np.full((24, 16), 131, np.uint8)).any()


images = st.builds(
    lambda seed, rows, columns, levels: (
        np.random.default_rng(seed).integers(0, levels, (4 * rows, 4 * columns)).astype(np.uint8)
    ),
    st.integers(0, 2**32 - 1), st.integers(1, 12), st.integers(1, 12),
    st.sampled_from([1, 2, 30, 256]),
)  # fmt: skip


@settings(max_examples=60)
@given(grey=images)
def test_the_kernels_agree(numba, grey):
    cells = numba.gradient_cells(grey)
    assert cells.shape == (31, grey.shape[0] // 4, grey.shape[1] // 4)
    assert cells.dtype == np.float32
    assert np.abs(cells - OPENCV.gradient_cells(grey)).max() < 1e-6
    assert np.array_equal(numba.gradient_cells(grey), cells)
