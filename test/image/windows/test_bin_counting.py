# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.image.windows.bin_counting import bin_counts, covered_region
from vehicle_pf_tracker.image.windows.window import Bounds, Window, bounds


def rectangles(*rows):
    return Bounds(*np.asarray(rows, dtype=np.intp).T)


def test_an_image_without_pixels_counts_nothing():
    empty = np.zeros((4, 0), np.uint8)
    assert bin_counts(empty, np.array([0]), 2, rectangles((0, 0, 0, 4))).tolist() == [[0]]


@settings(max_examples=50)
@given(
    seed=st.integers(0, 2**32 - 1),
    shape=st.tuples(st.integers(1, 40), st.integers(1, 40)),
    bins=st.integers(1, 90),
)
def test_counts_are_those_of_each_window_alone(seed, shape, bins):
    rng = np.random.default_rng(seed)
    indices = rng.integers(0, bins, shape)
    frame = np.zeros((*shape, 3), np.uint8)
    windows = bounds(frame, rng.uniform(0, 40, (7, 2)), Window(4, 6))
    active = np.flatnonzero(rng.random(bins) < 0.7)
    expected = [
        np.bincount(indices[top:bottom, left:right].ravel(), minlength=bins)[active]
        for left, top, right, bottom in zip(*windows, strict=True)
    ]
    assert np.array_equal(bin_counts(indices, active, bins, windows), expected)


@pytest.mark.parametrize("level", [0, 1])
def test_a_bin_that_fills_the_region_does_not_carry_into_the_next(level):
    # 1400 x 1400 px are two lanes of 21 bits in one plane; one lane takes all pixels.
    indices = np.full((1400, 1400), level, np.uint8)
    windows = rectangles((0, 0, 1400, 1400), (1, 2, 4, 6))
    expected = [[0, 0], [0, 0]]
    expected[0][level], expected[1][level] = 1400 * 1400, 12
    assert bin_counts(indices, np.array([0, 1]), 2, windows).tolist() == expected


def test_a_region_too_large_for_two_bins_at_once():
    indices = np.zeros((2100, 2100), np.uint8)
    indices[:, :5] = 1
    windows = rectangles((0, 0, 2100, 2100), (0, 0, 10, 10))
    counts = bin_counts(indices, np.array([0, 1]), 2, windows)
    assert counts.tolist() == [[2100 * 2095, 2100 * 5], [50, 50]]


@pytest.mark.parametrize(("margin", "shape"), [(0, (3, 5)), (1, (5, 6)), (50, (10, 20))])
def test_the_region_keeps_a_margin_as_far_as_there_are_pixels(margin, shape):
    frame = np.arange(10 * 20 * 3, dtype=np.uint16).astype(np.uint8).reshape(10, 20, 3)
    windows = rectangles((0, 2, 3, 5), (2, 3, 5, 5))
    region, local = covered_region(frame, windows, margin)
    assert region.shape[:2] == shape
    assert np.shares_memory(region, frame)
    for number in range(2):
        left, top, right, bottom = (side[number] for side in windows)
        inner = [side[number] for side in local]
        assert np.array_equal(
            region[inner[1] : inner[3], inner[0] : inner[2]], frame[top:bottom, left:right]
        )
