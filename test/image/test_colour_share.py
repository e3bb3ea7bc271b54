"""Colours that tell the target from its surroundings."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.colour_share import (
    bin_count,
    colour_bins,
    histogram,
    is_grey,
    mean_share_map,
    shares,
)

EVERY = np.random.default_rng(0).integers(0, 256, (50, 50, 3), dtype=np.uint8)


@pytest.mark.parametrize("grey", [False, True])
def test_bins_stay_in_range(grey):
    assert colour_bins(EVERY, grey=grey).max() < bin_count(grey=grey)


def test_a_bin_is_a_cube_of_sixteen_levels():
    pixels = np.array([[[0, 0, 0], [15, 15, 15], [16, 0, 0], [0, 16, 0], [0, 0, 16]]], np.uint8)
    assert colour_bins(pixels, grey=False).tolist() == [[0, 0, 256, 16, 1]]


def test_grey_video_is_told_by_finer_levels():
    pixels = np.repeat(np.array([0, 3, 4, 255], np.uint8), 3).reshape(1, 4, 3)
    assert colour_bins(pixels, grey=True).tolist() == [[0, 0, 1, 63]]


def test_grey_is_told_from_colour_through_coding_noise():
    level = EVERY[..., :1].repeat(3, axis=2)
    noisy = level.copy()
    noisy[::7, ::3, 0] ^= 1
    assert is_grey(level)
    assert is_grey(noisy)
    assert not is_grey(EVERY)


def test_a_colour_of_the_surroundings_counts_for_little():
    target, background = np.zeros(16), np.zeros(16)
    target[[1, 2]] = 0.5
    background[[2, 3]] = 0.5
    share = shares(target, background)
    assert share[1] > 0.99
    assert share[2] == pytest.approx(0.5)
    assert share[3] < 0.01
    assert share[9] == pytest.approx(0.5)


def test_histograms_sum_to_one_and_no_pixels_to_none():
    assert histogram(np.array([[1, 1], [3, 0]], np.uint16), 4).tolist() == [0.25, 0.5, 0.0, 0.25]
    assert histogram(np.empty(0, np.uint16), 4).tolist() == [0.0] * 4


def test_the_mean_share_is_largest_where_the_target_is():
    share = np.zeros((30, 40), np.float32)
    share[10:17, 20:31] = 1
    means = mean_share_map(share, (11, 7))
    assert means.shape == share.shape
    assert np.unravel_index(means.argmax(), means.shape) == (13, 25)
    assert means.max() == pytest.approx(1.0)
    assert means[0, 0] == 0
