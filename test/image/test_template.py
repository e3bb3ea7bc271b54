"""Correlation of templates, whole and its halves."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.template import (
    best_coefficient,
    correlate,
    halves,
    have_structure,
)

TEXTURE = np.random.default_rng(3).integers(0, 255, (40, 60)).astype(np.float32)


def test_a_template_is_found_where_it_was_cut():
    template = TEXTURE[12:22, 30:44]
    found = correlate(TEXTURE, template, have_structure(TEXTURE, (14, 10)))
    assert found.shape == (31, 47)
    assert np.unravel_index(found.argmax(), found.shape) == (12, 30)
    assert found.max() == pytest.approx(1.0, abs=1e-4)


def test_flat_windows_and_flat_templates_correlate_with_nothing():
    image = TEXTURE.copy()
    image[:, :30] = 90
    found = correlate(image, TEXTURE[5:15, 40:50], have_structure(image, (10, 10)))
    assert (found[:, :20] == 0).all()
    flat = np.full((10, 10), 7, np.float32)
    assert (correlate(image, flat, have_structure(image, (10, 10))) == 0).all()


def test_light_that_changes_as_a_whole_changes_nothing():
    image = TEXTURE[:20, :20].astype(np.uint8)
    assert best_coefficient(image, 0.5 * TEXTURE[4:14, 5:15] + 30) == pytest.approx(1.0, abs=1e-4)


def test_a_template_larger_than_the_image_is_not_found():
    assert best_coefficient(TEXTURE[:8, :20].astype(np.uint8), TEXTURE[:9, :9]) == 0


def test_halves_are_the_four_sides_of_a_patch():
    patch = np.arange(15).reshape(3, 5)
    left, right, upper, lower = (patch[half] for half in halves(patch.shape))
    assert left.tolist() == [[0, 1], [5, 6], [10, 11]]
    assert right.tolist() == [[3, 4], [8, 9], [13, 14]]
    assert upper.tolist() == [[0, 1, 2, 3, 4]]
    assert lower.tolist() == [[10, 11, 12, 13, 14]]
