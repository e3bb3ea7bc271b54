# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import check_frame
from vehicle_pf_tracker.image.windows.colour import JointColour, bin_indices
from vehicle_pf_tracker.image.windows.similarity import (
    bhattacharyya_coefficient,
    hellinger_distance,
)
from vehicle_pf_tracker.image.windows.window import Window


def test_bins_by_hand():
    # 255 >> 5 = 7, 64 >> 5 = 2, 31 >> 5 = 0: 7 * 64 + 2 * 8 + 0.
    pixels = np.array([[[255, 64, 31], [0, 0, 32], [32, 0, 0]]], np.uint8)
    assert bin_indices(pixels, 3).tolist() == [[464, 1, 64]]


def test_histogram_of_a_half_red_window():
    frame = np.zeros((5, 6, 3), np.uint8)
    frame[:, 3:, 0] = 255
    histogram = JointColour(3).histograms(frame, np.array([[3.5, 2.5]]), Window(1, 1))[0]
    # Pixels 2, 3, 4 of each row: one black, two red.
    assert histogram[0] == pytest.approx(1 / 3)
    assert histogram[7 * 64] == pytest.approx(2 / 3)
    assert histogram.sum() == pytest.approx(1)


def test_similarity_by_hand():
    p, q = np.array([0.5, 0.5, 0.0]), np.array([0.5, 0.0, 0.5])
    assert bhattacharyya_coefficient(p, q) == pytest.approx(0.5)
    assert hellinger_distance(0.5) == pytest.approx(np.sqrt(0.5))
    assert hellinger_distance(1.0 + 1e-12) == 0.0
    assert bhattacharyya_coefficient(p, p) == 1.0


@pytest.mark.parametrize(
    "frame",
    [
        np.zeros((4, 4), np.uint8),
        np.zeros((4, 4, 4), np.uint8),
        np.zeros((4, 4, 3), np.float32),
        np.zeros((0, 4, 3), np.uint8),
    ],
)
def test_what_is_no_frame_is_refused(frame):
    with pytest.raises(InputError, match="frame"):
        check_frame(frame)
