# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Patches of canonical size: exact on ramps, and a map that goes both ways."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation.canonical_patch import cut_patch

WIDTH, HEIGHT = 240, 180
SLOPE = np.array([0.6, 0.5])


def ramp(x, y):
    """Luminance at continuous px of the frame; the centre of the first pixel is at (0.5, 0.5)."""
    return 20 + SLOPE[0] * (x - 0.5) + SLOPE[1] * (y - 0.5)


def frame():
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    return np.rint(ramp(x, y)).astype(np.uint8)[..., np.newaxis].repeat(3, axis=2)


def expected(patch):
    """Ramp at every pixel of the patch; outside the frame its outermost pixels are repeated."""
    middles = np.arange(patch.side) + 0.5
    x, _ = patch.to_frame(np.stack([middles, middles], axis=-1)).T
    _, y = patch.to_frame(np.stack([middles, middles], axis=-1)).T
    x, y = np.clip(x, 0.5, WIDTH - 0.5), np.clip(y, 0.5, HEIGHT - 0.5)
    return ramp(*np.meshgrid(x, y))


@pytest.mark.parametrize("zoom", [(1.0, 1.0), (2.3, 0.9), (0.55, 0.55), (0.35, 0.4), (0.2, 0.25)])
def test_a_ramp_is_resampled_without_bias(zoom):
    patch = cut_patch(frame(), np.array([121.3, 88.6]), np.array(zoom), 32)
    difference = patch.grey - expected(patch)
    assert np.abs(difference).max() < 1.1
    # A position wrong by half a pixel of the reduced frame would show in the mean.
    assert abs(difference.mean()) < 0.12


@pytest.mark.parametrize("zoom", [1.0, 3.0, 0.3])
@pytest.mark.parametrize("centre", [(0.0, 0.0), (WIDTH, 90.0), (120.0, HEIGHT + 4.0), (-30, -20)])
def test_beyond_the_border_the_outermost_pixels_are_repeated(zoom, centre):
    patch = cut_patch(frame(), np.array(centre, float), np.array([zoom, zoom]), 32)
    # Blocks of up to 3 px that are averaged lie inside, so that the border is off by up to one.
    assert np.abs(patch.grey - expected(patch)).max() < (1.1 if zoom >= 1 else 2.3)


def test_reduction_averages_instead_of_skipping_pixels():
    """All of small blocks, some of large ones."""
    for zoom, width in ((0.35, 3), (0.25, 4)):
        stripes = np.zeros((240, 240, 3), np.uint8)
        stripes[:, ::width] = 60 * width
        patch = cut_patch(stripes, np.array([120.0, 120.0]), np.array([zoom, zoom]), 32)
        assert patch.grey == pytest.approx(np.full((32, 32), 60), abs=1)


@pytest.mark.parametrize("zoom", [0.24, 0.16, 0.1])
def test_large_blocks_are_where_they_are(zoom):
    """A ramp of 900 px, of which not all rows are read."""
    x, y = np.meshgrid(np.arange(900), np.arange(900))
    for along in (x, y):
        grey = (along * 0.25).astype(np.uint8)[..., np.newaxis].repeat(3, axis=2)
        patch = cut_patch(grey, np.array([451.3, 448.6]), np.array([zoom, zoom]), 64)
        place = patch.to_frame(np.array([32.0, 32.0]))[0 if along is x else 1]
        middle = patch.grey[31:33, 31:33].mean()
        assert middle == pytest.approx(0.25 * (place - 0.5) - 0.375, abs=0.5)


def test_to_frame_inverts_to_patch():
    patch = cut_patch(frame(), np.array([60.5, 40.25]), np.array([0.7, 1.9]), 32)
    positions = np.random.default_rng(1).uniform(0, 100, (3, 5, 2))
    assert patch.to_frame(patch.to_patch(positions)) == pytest.approx(positions)
    assert patch.to_patch(patch.centre) == pytest.approx([16, 16])
    assert patch.to_patch(patch.centre + np.array([10, -10])) == pytest.approx([23, -3])


def test_the_middle_shows_what_a_smaller_patch_shows():
    centre, zoom = np.array([101.7, 77.2]), np.array([1.3, 0.8])
    large, small = cut_patch(frame(), centre, zoom, 64), cut_patch(frame(), centre, zoom, 32)
    middle = large.middle(32)
    assert np.abs(middle.grey.astype(int) - small.grey).max() <= 1
    assert middle.to_patch(centre) == pytest.approx(small.to_patch(centre))


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (5, 1)])
def test_tiny_frames_are_borne(size):
    for zoom in (0.05, 0.4, 8.0):
        tiny = np.full((*size, 3), 77, np.uint8)
        patch = cut_patch(tiny, np.array([0.5, 0.5]), np.array([zoom, zoom]), 32)
        assert (patch.grey == 77).all()
