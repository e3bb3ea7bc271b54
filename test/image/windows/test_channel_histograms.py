# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from feature_samples import checkerboard

from vehicle_pf_tracker.image.windows.colour import RgbMarginals, marginal_bins
from vehicle_pf_tracker.image.windows.window import Window


def test_bins_are_a_21st_of_256():
    # 12 * 21 / 256 = 0.98, 13 * 21 / 256 = 1.07, 255 * 21 / 256 = 20.9 (interpretation 20).
    assert marginal_bins(np.array([[[0, 12, 13], [243, 244, 255]]], np.uint8)).tolist() == [
        [[0, 0, 1], [19, 20, 20]]
    ]


def test_histogram_of_a_checkerboard_by_hand():
    # 3 x 3 pixels around a dark one: five dark, four light.
    histogram = RgbMarginals().histograms(checkerboard(), np.array([[3.5, 3.5]]), Window(1, 1))[0]
    for channel in range(3):
        assert histogram[21 * channel] == pytest.approx(5 / 27)
        assert histogram[21 * channel + 20] == pytest.approx(4 / 27)
