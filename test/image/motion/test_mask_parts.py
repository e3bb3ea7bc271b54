# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of masks, by hand, and of masks that have more of them than 16 bits can number."""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.mask_parts import connected_parts


def test_parts_that_touch_by_a_corner_are_one():
    mask = np.array(
        [
            [1, 1, 0, 0, 0],
            [0, 0, 1, 0, 1],
            [0, 0, 0, 0, 1],
        ],
        np.uint8,
    )
    labels, stats = connected_parts(mask)
    assert labels.tolist() == [[1, 1, 0, 0, 0], [0, 0, 1, 0, 2], [0, 0, 0, 0, 2]]
    # Left, top, width, height, area; 10 of 15 px are outside.
    assert stats[1:].tolist() == [[0, 0, 3, 2, 3], [4, 1, 1, 2, 2]]
    assert stats[0, 4] == 10


@pytest.mark.parametrize("side", [509, 511])
def test_as_many_parts_as_a_mask_can_have_are_told_apart(side):
    mask = np.zeros((side, side), np.uint8)
    mask[::2, ::2] = 1
    # 255 a side are within 16 bits, 256 a side are not.
    labels, stats = connected_parts(mask)
    assert len(stats) - 1 == labels.max() == ((side + 1) // 2) ** 2


@pytest.mark.parametrize("share", [0.02, 0.3, 0.7])
def test_parts_have_the_numbers_that_labels_of_32_bits_give(share):
    mask = (np.random.default_rng(1).random((90, 121)) < share).astype(np.uint8)
    labels, stats = connected_parts(mask)
    _, wide, expected, _ = cv2.connectedComponentsWithStats(mask, ltype=cv2.CV_32S)
    assert np.array_equal(labels, wide)
    assert np.array_equal(stats, expected)
