# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Training of the network for the sides: its parts, its errors, and that it learns."""

import numpy as np
import pytest

from laboratory.side_examples import Examples, by_output
from laboratory.side_training import trained
from laboratory.train_sides import deviations, left_out_errors, parts_of
from vehicle_pf_tracker.image.patches.side_network import CELLS, CHANNELS


def test_a_camera_is_in_one_part_and_parts_have_about_as_many_boxes():
    camera = np.repeat([0, 1, 2, 3, 4, 5, 6, 7], [9, 1, 5, 5, 4, 4, 2, 2])
    part = parts_of(camera)
    of_camera = [{*part[camera == number].tolist()} for number in range(8)]
    assert all(len(parts) == 1 for parts in of_camera)
    # The largest first, each to the part with fewest boxes: 9; 5 + 2 + 1; 5 + 2; 4 + 4.
    assert sorted(np.bincount(part).tolist()) == [7, 8, 8, 9]


def test_the_right_side_counts_as_the_left_one_of_the_mirrored_image():
    left, top, right, bottom = 0.1, 0.2, 0.3, 0.4
    outputs = by_output(np.array([[left, top, right, bottom]], np.float32))
    assert outputs == pytest.approx(np.array([[left, top, bottom], [right, top, bottom]]))


def test_deviations_by_hand():
    errors = np.zeros((4, 4), np.float32)
    # One vehicle's left side is off by .3 and .1, the other's by .0 and .2.
    errors[:, 0] = 0.3, 0.1, 0.0, 0.2
    bias, noise = deviations(errors, np.array([0, 0, 1, 1]))
    # Squared means .04 and .01; the right side has none. Variances .01 each.
    assert bias == pytest.approx([np.sqrt((0.025 + 0) / 2), 0, 0])
    assert noise == pytest.approx([np.sqrt((0.01 + 0) / 2), 0, 0])


def drawn(count: int, seed: int) -> Examples:
    """Noise whose level at each rim says how far that side is off, in two channels of their own."""
    rng = np.random.default_rng(seed)
    cells = rng.normal(0, 0.1, (count, CHANNELS, CELLS, CELLS)).astype(np.float16)
    beyond = rng.uniform(-0.2, 0.2, (count, 4)).astype(np.float32)
    rim = CELLS // 4
    for index, (left, top, right, bottom) in enumerate(beyond):
        cells[index, 0, :, :rim] += np.float16(5 * left)
        cells[index, 0, :, -rim:] += np.float16(5 * right)
        cells[index, -1, :rim] += np.float16(5 * top)
        cells[index, -1, -rim:] += np.float16(5 * bottom)
    numbers = np.zeros(count, np.intp)
    return Examples(cells, beyond, numbers, numbers, ("one",))


def test_a_network_finds_sides_in_boxes_that_it_has_not_seen():
    network = trained(drawn(4096, 0))
    unseen = drawn(100, 1)
    errors = left_out_errors(unseen, np.zeros(100, np.intp), [network])
    # Nine tenths of the variance are found.
    assert errors.var(axis=0).max() < 0.1 * unseen.beyond.var()


def test_the_same_boxes_give_the_same_network():
    one, other = (trained(drawn(256, 0)) for _ in range(2))
    for weights, again in zip(one, other, strict=True):
        np.testing.assert_array_equal(weights, again)
