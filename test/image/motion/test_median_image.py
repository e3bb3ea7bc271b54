# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Median of images, beside that of sorted values."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.median_image import median


@pytest.mark.parametrize("count", range(1, 21))
def test_the_median_is_that_of_each_pixel(count):
    images = list(np.random.default_rng(count).integers(0, 256, (count, 9, 7)).astype(np.uint8))
    expected = np.sort(images, axis=0)[count // 2]
    assert np.array_equal(median(images), expected)
