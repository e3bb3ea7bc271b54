# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Comparison of an image with the background, by hand."""

from dataclasses import replace

import numpy as np
import pytest

from vehicle_pf_tracker.detection.background import Background
from vehicle_pf_tracker.detection.motion_thresholds import SHIPPED_THRESHOLDS


@pytest.mark.parametrize(("threshold", "has_changed"), [(32.0, True), (32.5, False)])
def test_a_pixel_has_changed_from_the_threshold_on_also_between_whole_numbers(
    threshold, has_changed
):
    shape = (12, 16, 3)
    thresholds = replace(SHIPPED_THRESHOLDS, colour_threshold=threshold)
    background = Background(shape, 1, thresholds)
    grey = np.full(shape, 100, np.uint8)
    while not background.is_known:
        background.begin(grey, 1.0)
    image = grey.copy()
    # 32 levels apart in all channels together, and brighter, so that it is no shadow.
    image[5, 7] += np.array([12, 10, 10], np.uint8)
    changed = background.compare(image)
    assert changed[5, 7] == has_changed
    assert np.count_nonzero(changed) == has_changed
