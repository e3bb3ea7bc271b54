# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The three textures of P2 on images whose values are known by hand."""

import numpy as np
import pytest
from feature_samples import checkerboard, ramp, step_edge

from vehicle_pf_tracker.image.windows.textures import (
    BinaryPatterns,
    Cooccurrence,
    HaralickStatistics,
    descriptors,
    pair_bins,
    patterns,
)
from vehicle_pf_tracker.image.windows.window import Window


def one(feature, frame, position, window):
    return feature.histograms(frame, np.array([position]), window)[0]


def test_pairs_look_east():
    # Levels 0 1 7: the pairs are (0, 1) and (1, 7).
    assert pair_bins(np.array([[0, 32, 255]], np.uint8)).tolist() == [[1, 15]]


def test_cooccurrence_of_a_step_edge_by_hand():
    # Columns 4 to 8 of levels 0 0 6 6 6: pairs 00 06 66 66 in each row.
    histogram = one(Cooccurrence(), step_edge(), (6.5, 4.5), Window(2, 2))
    assert histogram[[0, 6, 54]].tolist() == [0.25, 0.25, 0.5]


def test_cooccurrence_of_a_checkerboard_is_two_sided():
    histogram = one(Cooccurrence(), checkerboard(), (3.5, 3.5), Window(1, 1))
    # Six pairs: dark to light (0, 7) and light to dark (7, 0), three each.
    assert histogram[[7, 56]].tolist() == [0.5, 0.5]


def test_a_window_of_one_column_has_no_pairs():
    assert not one(Cooccurrence(), ramp(), (6.5, 4.5), Window(0, 3)).any()
    assert not one(HaralickStatistics(), ramp(), (6.5, 4.5), Window(0, 3)).any()


def test_pattern_of_a_pixel_by_hand():
    # Clockwise from the top left of the 5: 6 1 5 9 2 5 4 3; bits 0, 2, 3 and 5 are not darker.
    levels = np.array([[6, 1, 5], [3, 5, 9], [4, 5, 2]], np.uint8)
    assert patterns(levels)[1, 1] == 0b00101101


def test_patterns_of_a_checkerboard_by_hand():
    # Dark pixels see nothing darker; light ones see equal ones at the corners: bits 0 2 4 6.
    histogram = one(BinaryPatterns(), checkerboard(), (3.5, 3.5), Window(1, 1))
    assert histogram[255] == pytest.approx(5 / 9)
    assert histogram[0b01010101] == pytest.approx(4 / 9)


def test_statistics_of_a_checkerboard_by_hand():
    matrix = np.zeros((1, 64))
    matrix[0, [7, 56]] = 0.5
    # Contrast 49 of 49; homogeneity 1 / (1 + 7); uniformity 2 / 4; entropy log 2 of log 64.
    assert descriptors(matrix)[0] == pytest.approx([0.5, 1.0, 0.125, 0.5, 1 / 6])


def test_statistics_become_a_histogram_of_two_bins_each():
    histogram = one(HaralickStatistics(), checkerboard(), (3.5, 3.5), Window(1, 1))
    expected = [0.5, 0.5, 1.0, 0.0, 0.125, 0.875, 0.5, 0.5, 1 / 6, 5 / 6]
    assert histogram == pytest.approx(np.array(expected) / 5)
