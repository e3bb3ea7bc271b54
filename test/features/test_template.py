"""Correlation of templates, whole and by halves."""

import numpy as np
import pytest

from vehicle_pf_tracker.features.template import (
    coefficient,
    correlate,
    half_coefficients,
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
    assert coefficient(flat, TEXTURE[:10, :10]) == 0


def test_light_that_changes_as_a_whole_changes_nothing():
    patch = TEXTURE[:10, :10]
    assert coefficient(patch, 0.5 * patch + 30) == pytest.approx(1.0)


def test_the_half_that_is_not_hidden_still_matches():
    patch = TEXTURE[:12, :16]
    hidden = patch.copy()
    hidden[:, 8:] = TEXTURE[20:32, 40:48]
    left, right, upper, lower = half_coefficients(hidden, patch)
    assert left == pytest.approx(1.0)
    assert abs(right) < 0.4
    assert upper < 0.9
    assert lower < 0.9
    assert coefficient(hidden, patch) < 0.8
