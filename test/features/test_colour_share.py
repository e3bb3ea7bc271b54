"""Colours that tell the target from its surroundings."""

import numpy as np
import pytest

from vehicle_pf_tracker.features.colour_share import (
    BINS,
    colour_bins,
    contrast_map,
    histogram,
    shares,
)


def test_bins_stay_in_range_and_grey_levels_differ():
    every = np.random.default_rng(0).integers(0, 256, (50, 50, 3), dtype=np.uint8)
    bins = colour_bins(every)
    assert bins.min() >= 0
    assert bins.max() < BINS
    grey = np.repeat(np.arange(0, 256, 16, dtype=np.uint8), 3).reshape(1, 16, 3)
    assert len(set(colour_bins(grey).ravel().tolist())) == 16


def test_a_colour_of_the_surroundings_counts_for_little():
    target, background = np.zeros(BINS), np.zeros(BINS)
    target[[1, 2]] = 0.5
    background[[2, 3]] = 0.5
    share = shares(target, background)
    assert share[1] > 0.99
    assert share[2] == pytest.approx(0.5)
    assert share[3] < 0.01
    assert share[9] == pytest.approx(0.5)


def test_no_pixels_are_a_uniform_histogram():
    assert histogram(np.empty(0, np.intp)) == pytest.approx(np.full(BINS, 1 / BINS))


def test_contrast_is_largest_where_the_target_is():
    share = np.zeros((30, 40), np.float32)
    share[10:18, 20:32] = 1
    contrast = contrast_map(share, (12, 8), 4)
    assert contrast.shape == (23, 29)
    assert np.unravel_index(contrast.argmax(), contrast.shape) == (10, 20)
    assert contrast.max() == pytest.approx(1.0)
    assert contrast[0, 0] <= 0
