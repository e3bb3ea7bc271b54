# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that are never found, and numbers on no vehicle."""

import numpy as np
import pytest
from scored_scenes import scene

from vehicle_pf_tracker.evaluation.traffic.followed import false_numbers, never_found

FRAMES = range(1, 11)
SIZE = (200, 100)


def row(frame, identity, left=20.0):
    return [frame, identity, left, 40.0, 20.0, 10.0]


def two_vehicles(hidden=()):
    """Vehicle 7 at 20 px and 8 at 100 px, for ten frames; 8 is totally hidden in some."""
    truth = [row(f, v, left) for f in FRAMES for v, left in ((7, 20.0), (8, 100.0))]
    return scene(truth, SIZE, [v == 8 and f in hidden for f, v, *_ in truth])


def tracks(*rows):
    return np.array(rows, dtype=float).reshape(-1, 6)


def test_a_vehicle_is_found_by_one_box_that_fits():
    assert never_found(two_vehicles(), tracks()) == (2, 2)
    assert never_found(two_vehicles(), tracks(row(4, 1))) == (1, 2)
    # 12 px off, a box of 20 px overlaps by 8 of 32.
    assert never_found(two_vehicles(), tracks(row(4, 1, 32.0))) == (2, 2)
    assert never_found(two_vehicles(), tracks(row(4, 1), row(9, 2, 100.0))) == (0, 2)


def test_a_vehicle_that_is_never_in_sight_is_not_missed():
    assert never_found(two_vehicles(hidden=FRAMES), tracks(row(4, 1))) == (0, 1)


@pytest.mark.parametrize(("on_vehicle", "false"), [(0, 1), (2, 1), (3, 0), (10, 0)])
def test_a_number_is_false_below_three_boxes_in_ten(on_vehicle, false):
    rows = [row(f, 1, 20.0 if f <= on_vehicle else 60.0) for f in FRAMES]
    assert false_numbers(two_vehicles(), tracks(*rows)) == false


def test_a_number_on_a_hidden_vehicle_is_not_false():
    assert false_numbers(two_vehicles(hidden=FRAMES), tracks(row(4, 1, 100.0))) == 0


def test_two_numbers_on_one_vehicle_are_not_false_but_a_second_box_beside_it_is():
    halves = [row(f, 1 if f <= 5 else 2) for f in FRAMES]
    assert false_numbers(two_vehicles(), tracks(*halves)) == 0
    doubled = [row(f, identity) for f in FRAMES for identity in (1, 2)]
    assert false_numbers(two_vehicles(), tracks(*doubled)) == 1
