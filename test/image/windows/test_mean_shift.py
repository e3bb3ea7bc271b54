# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mean shift on images small enough to do by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.image.windows.mean_shift import (
    epanechnikov,
    kernel_histogram,
    kernel_similarity,
    mean_shift,
)
from vehicle_pf_tracker.image.windows.similarity import Reference
from vehicle_pf_tracker.image.windows.window import Window

RED, GREEN, BLACK = (255, 0, 0), (0, 255, 0), (0, 0, 0)
RED_BIN, GREEN_BIN = 4, 2  # one bit a channel, red highest
CROSS = Window(1, 1)


def image(*rows):
    colours = {"r": RED, "g": GREEN, ".": BLACK}
    return np.array([[colours[letter] for letter in row] for row in rows], np.uint8)


def histogram(**shares):
    made = np.zeros(8)
    for name, share in shares.items():
        made[{"red": RED_BIN, "green": GREEN_BIN, "black": 0}[name]] = share
    return Reference(made)


def test_kernel_by_hand():
    # Radius 1.5 px: the middle has 1, its neighbours 1 - 1 / 2.25, the corners 1 - 2 / 2.25.
    offsets, profile = epanechnikov(CROSS)
    weight = {tuple(map(int, xy)): p for xy, p in zip(offsets, profile, strict=True)}
    assert len(weight) == 9
    assert weight[0, 0] == pytest.approx(1.0)
    assert weight[1, 0] == weight[0, -1] == pytest.approx(5 / 9)
    assert weight[1, 1] == pytest.approx(1 / 9)


def test_kernel_histogram_by_hand():
    # Profile sum: 1 + 4 * 5/9 + 4 * 1/9 = 33/9. Red: the middle and one neighbour, 14/9.
    frame = image("...", ".rr", "..g")
    found = kernel_histogram(frame, (1.5, 1.5), CROSS, 1)
    assert found[RED_BIN] == pytest.approx(14 / 33)
    assert found[GREEN_BIN] == pytest.approx(1 / 33)
    assert found[0] == pytest.approx(18 / 33)


def test_similarity_by_hand():
    frame = image("...", ".rr", "..g")
    rho = kernel_similarity(frame, np.array([[1.5, 1.5]]), CROSS, histogram(red=1.0), 1)
    assert rho == pytest.approx([np.sqrt(14 / 33)])


def test_one_step_by_hand():
    # Only red pixels pull: the middle and its right neighbour, both with the same weight.
    frame = image("...", ".rr", "..g")
    shifted = mean_shift(frame, np.array([[1.5, 1.5]]), CROSS, histogram(red=1.0), 1)
    assert shifted == pytest.approx(np.array([[2.0, 1.5]]))


def test_pixels_weigh_by_the_root_of_what_the_target_has_over_what_the_window_has():
    # A row of three: profile 5/9, 1, 5/9, so that red has 5/19 and green 14/19 of the window.
    reference = histogram(red=45 / 76, green=31 / 76)
    # Roots of q / p: 3/2 for red, sqrt(31 / 56) for green.
    green = np.sqrt(31 / 56)
    (moved,) = mean_shift(image("rgg"), np.array([[1.5, 0.5]]), Window(1, 0), reference, 1)
    assert moved == pytest.approx([1.5 + (green - 1.5) / (1.5 + 2 * green), 0.5])


def test_without_a_colour_of_the_target_nothing_moves():
    start = np.array([[1.2, 0.9]])
    assert np.array_equal(
        mean_shift(image("...", "..."), start, CROSS, histogram(red=1.0), 1), start
    )


def test_many_windows_at_once_are_each_as_alone():
    rng = np.random.default_rng(0)
    frame = rng.integers(0, 256, (40, 60, 3), dtype=np.uint8)
    window, positions = Window(6, 4), rng.uniform([0, 0], [60, 40], (25, 2))
    reference = Reference(kernel_histogram(frame, (30.0, 20.0), window, 2))
    together = mean_shift(frame, positions, window, reference, 2)
    similar = kernel_similarity(frame, positions, window, reference, 2)
    for index, position in enumerate(positions):
        alone = position[np.newaxis]
        assert mean_shift(frame, alone, window, reference, 2)[0] == pytest.approx(together[index])
        assert kernel_similarity(frame, alone, window, reference, 2)[0] == pytest.approx(
            similar[index]
        )


def test_steps_end_on_the_patch():
    frame = np.zeros((60, 80, 3), np.uint8)
    frame[20:31, 30:45] = RED
    window = Window(7, 5)
    reference = Reference(kernel_histogram(frame, (37.5, 25.5), window, 3))
    position = np.array([[30.0, 21.0]])
    for _ in range(15):
        position = mean_shift(frame, position, window, reference, 3)
    assert position == pytest.approx(np.array([[37.5, 25.5]]), abs=1.0)


@given(
    st.tuples(st.floats(-50, 100), st.floats(-50, 100)),
    st.integers(0, 40),
    st.integers(0, 40),
    st.integers(0, 99),
)
def test_positions_stay_in_the_image(start, half_width, half_height, seed):
    rng = np.random.default_rng(seed)
    frame = rng.integers(0, 256, (12, 17, 3), dtype=np.uint8)
    window = Window(half_width, half_height)
    reference = Reference(kernel_histogram(frame, (3.0, 4.0), window, 1))
    assert reference.histogram.sum() == pytest.approx(1.0)
    inside = np.clip(np.array([start]), 0.5, [16.5, 11.5])
    shifted = mean_shift(frame, inside, window, reference, 1)
    assert np.all(shifted >= 0.5 - 1e-9)
    assert np.all(shifted <= [16.5 + 1e-9, 11.5 + 1e-9])


def test_kernel_histogram_in_a_corner_takes_the_pixels_that_exist():
    # The middle, two neighbours and a corner: 1 + 10/9 + 1/9 = 20/9, of which red is 9/9.
    found = kernel_histogram(image("rg.", "g..", "..."), (0.5, 0.5), CROSS, 1)
    assert found[RED_BIN] == pytest.approx(9 / 20)
    assert found[GREEN_BIN] == pytest.approx(10 / 20)
