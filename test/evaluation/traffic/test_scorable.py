# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Which boxes of many vehicles are scored."""

import numpy as np
import pytest
from scored_scenes import scene

from vehicle_pf_tracker.evaluation.traffic.box_matches import matches, overlaps
from vehicle_pf_tracker.evaluation.traffic.scorable import scorable


def sequence(truth, hidden, ignored=()):
    return scene(truth, (100, 100), hidden, ignored, frames=2)


def kept(made, *boxes):
    """Frame 1's tracks that are scored, by the order of `boxes`."""
    rows = np.array([[1, i, *box] for i, box in enumerate(boxes)], dtype=float)
    return scorable(made, rows)[1][:, 1].tolist()


def test_overlap_is_intersection_over_union():
    first = np.array([[0, 0, 10, 10]], dtype=float)
    second = np.array([[5, 0, 10, 10], [0, 0, 10, 10], [20, 0, 5, 5]], dtype=float)
    assert overlaps(first, second)[0] == pytest.approx([1 / 3, 1, 0])


def test_matching_is_one_to_one_and_needs_half():
    boxes = np.array([[0, 0, 10, 10], [40, 0, 10, 10]], dtype=float)
    others = np.array([[1, 0, 10, 10], [0, 0, 10, 10], [46, 0, 10, 10]], dtype=float)
    rows, columns = matches(boxes, others)
    assert (rows.tolist(), columns.tolist()) == ([0], [1])


def test_hidden_vehicles_and_the_boxes_on_them_are_not_scored():
    made = sequence([[1, 1, 0, 0, 10, 10], [1, 2, 50, 0, 10, 10]], [True, False])
    truth, _ = scorable(made, np.empty((0, 6)))
    assert truth[:, 1].tolist() == [2]
    assert kept(made, [1, 0, 10, 10], [50, 0, 10, 10], [6, 0, 10, 10]) == [1, 2]


def test_a_box_on_a_vehicle_in_sight_counts_even_if_a_hidden_one_is_nearer():
    made = sequence([[1, 1, 0, 0, 10, 10], [1, 2, 3, 0, 10, 10]], [True, False])
    assert kept(made, [0.5, 0, 10, 10]) == [0]


def test_unmatched_boxes_mostly_in_a_region_are_left_out():
    regions = [[0, 0, 0, 100, 10], [2, 0, 50, 100, 10]]
    made = sequence([[1, 1, 30, 0, 10, 10]], [False], regions)
    boxes = [30, 0, 10, 10], [60, 0, 10, 18], [80, 0, 10, 22], [0, 50, 10, 10]
    assert kept(made, *boxes) == [0, 2, 3]  # the second region is of another frame
