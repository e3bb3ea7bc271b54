# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The network that tells where a vehicle ends: its file, its cells and its mirror image."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.kernels.interface import Kernels, load_kernels
from vehicle_pf_tracker.image.patches.side_network import (
    CELLS,
    CHANNELS,
    FILE,
    SideNetwork,
    mirrored,
    side_cells,
    side_network,
)

CENTRE, SIZE = np.array([60.0, 50.0]), np.array([40.0, 20.0])
RNG = np.random.default_rng(1)
TEXTURE = RNG.integers(0, 256, (100, 120, 3)).astype(np.uint8)


def test_the_file_has_the_shapes_that_the_cells_have():
    network = side_network()
    hidden = len(network.hidden)
    assert network.first.shape == (CHANNELS * CELLS**2, hidden)
    assert network.second.shape == (hidden, 3)
    assert network.last.shape == network.noise.shape == (3,)
    assert all(np.isfinite(layer).all() for layer in network)
    # Errors on cameras that were left out: below what the boxes were off (.14), and not nothing.
    assert (network.noise > 0.03).all()
    assert (network.noise < 0.12).all()
    assert FILE.stat().st_size < 100_000


def test_a_network_is_written_in_half_precision(tmp_path):
    layers = [RNG.normal(size=shape) for shape in ((6, 2), (2,), (2, 3), (3,), (3,))]
    network = SideNetwork(*(layer.astype(np.float32) for layer in layers))
    network.write(tmp_path / "a.npz")
    again = SideNetwork.read(tmp_path / "a.npz")
    assert np.array_equal(again.first, network.first.astype(np.float16))
    assert all(np.array_equal(*pair) for pair in zip(again[1:], network[1:], strict=True))
    assert all(layer.dtype == np.float32 for layer in again)


def test_the_right_side_is_the_left_one_of_the_mirror_image():
    """One unit that reads the lightness of the first column, and one that is always on."""
    weights = np.zeros((CHANNELS, CELLS, CELLS, 2), np.float32)
    weights[-3, :, 0, 0] = 1 / CELLS
    second = np.array([[1, 0, 0], [0, 2, 4]], np.float32)
    offsets = np.array([0, 1], np.float32)
    last = np.array([0.5, 0, 0], np.float32)
    network = SideNetwork(weights.reshape(-1, 2), offsets, second, last, np.ones(3, np.float32))
    cells = np.zeros((CHANNELS, CELLS, CELLS), np.float32)
    cells[-3, :, 0] = 0.25
    cells[-3, :, -1] = 0.125
    assert network.beyond(cells) == pytest.approx(np.array([[0.75, 2], [0.625, 4]]))
    assert network.noise_by_side == pytest.approx(np.ones((2, 2)))


def test_cells_of_a_mirrored_image_are_mirrored_cells():
    plain = side_cells(TEXTURE, CENTRE, SIZE, Kernels())
    turned = side_cells(np.ascontiguousarray(TEXTURE[:, ::-1]), CENTRE, SIZE, Kernels())
    # A gradient halfway between two directions has another neighbour in the mirror.
    assert np.abs(turned - mirrored(plain)).mean() < 0.002
    assert np.abs(turned - plain).mean() > 0.02
    assert np.array_equal(mirrored(mirrored(plain)), plain)


def test_cells_are_of_the_box_whatever_its_shape():
    """A white box on black is ten cells wide and high, in the middle of sixteen."""
    frame = np.zeros((100, 120, 3), np.uint8)
    frame[40:60, 40:80] = 255
    cells = side_cells(frame, CENTRE, SIZE, Kernels())
    assert cells.shape == (CHANNELS, CELLS, CELLS)
    bright = cells[-3] > 0
    assert bright[4:12, 4:12].all()
    assert not bright[:2].any() and not bright[:, :2].any()
    assert not bright[-2:].any() and not bright[:, -2:].any()


def test_both_kernels_measure_the_same_cells():
    other = load_kernels("auto")
    ours, theirs = (side_cells(TEXTURE, CENTRE, SIZE, each) for each in (Kernels(), other))
    assert theirs == pytest.approx(ours, abs=1e-5)


def test_the_network_sees_on_which_side_a_vehicle_is_beyond_its_box():
    """A drawn car, whose like it has not learnt from: by a sixth to either side."""
    frame = np.full((100, 120, 3), 110, np.uint8)
    frame[38:62, 40:80] = (170, 30, 30)
    frame[42:50, 46:74] = (40, 40, 50)
    frame[60:66, 44:52] = frame[60:66, 68:76] = 20
    size = np.array([40.0, 28.0])
    left, right = (
        side_network().beyond(side_cells(frame, np.array([x, 52.0]), size, Kernels()))
        for x in (66.5, 53.5)
    )
    assert left[0, 0] > left[1, 0] + 0.1
    assert right[1, 0] > right[0, 0] + 0.1
