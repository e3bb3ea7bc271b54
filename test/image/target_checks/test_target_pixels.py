# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Doubts about targets."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.target_checks.target_pixels import contrast, doubts


@pytest.fixture
def frame():
    """Asphalt with noise, and a striped vehicle on it."""
    rng = np.random.default_rng(0)
    image = np.clip(rng.normal(110, 6, (120, 160, 1)), 0, 255).astype(np.uint8).repeat(3, axis=2)
    image[40:60, 40:70] = (40, 60, 160)
    image[44:50, 45:65] = (220, 220, 230)
    return image


def test_a_vehicle_raises_no_doubts(frame):
    assert doubts(frame, Box(40, 40, 30, 20)) == []


@pytest.mark.parametrize(
    ("box", "words"),
    [
        (Box(45, 44, 5, 8), "it is only 5 x 8 px large"),
        (Box(0, 0, 120, 110), "it covers 69% of the image"),
        (Box(90, 70, 40, 30), "nothing in it stands out"),
        (Box(-10, 90, 40, 30), "nothing in it stands out"),
    ],
)
def test_what_speaks_against_a_target(frame, box, words):
    (found,) = doubts(frame, box)
    assert words in found


def test_a_box_beyond_the_image_has_no_pixels_to_doubt(frame):
    assert doubts(frame, Box(400, 400, 20, 20)) == []


def test_a_patch_whose_contrast_is_known():
    """Two halves of 100 and 120 have a standard deviation of 10, less what smoothing takes."""
    frame = np.full((80, 80, 3), 100, np.uint8)
    frame[:, 40:] = 120
    assert contrast(frame, Box(20, 20, 40, 40)) == pytest.approx(10, abs=0.5)
    assert contrast(np.full((80, 80, 3), 100, np.uint8), Box(20, 20, 40, 40)) == 0
