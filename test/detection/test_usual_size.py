# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Usual size of vehicles by place, and how many of them a blob holds by it."""

import pytest

from vehicle_pf_tracker.detection.pieces import Piece
from vehicle_pf_tracker.detection.usual_size import UsualSize


def square(left, bottom, side):
    return Piece(left, bottom - side, left + side, bottom, side**2)


def learnt(*sides, bottom=100):
    """Sizes after squares that stand side by side on one row."""
    sizes = UsualSize()
    for index, side in enumerate(sides):
        sizes.learn(square(10 + index, bottom, side))
    sizes.settle()
    return sizes


def test_ten_boxes_tell_how_many_a_blob_holds_and_decide_nothing():
    blob = Piece(0, 60, 80, 100, 3200)
    sizes = learnt(*[20] * 9)
    assert not sizes.is_roughly_known
    assert sizes.vehicles_in(blob) == 0
    sizes = learnt(*[20] * 10)
    assert sizes.is_roughly_known
    # 80 x 40 px are eight times 20 x 20; each area holds nine tenths of a vehicle.
    assert sizes.vehicles_in(blob) == pytest.approx(7.2)
    assert sizes.deviation(square(0, 100, 5)) == 0


def test_a_lorry_is_one_vehicle():
    # Of 1.6 usual areas: 1.44 vehicles, and less than one and a half.
    assert learnt(*[20] * 10).vehicles_in(Piece(0, 80, 32, 100, 640)) == 0


def test_no_size_is_known_far_from_those_that_were_learnt():
    sizes = UsualSize()
    for index in range(12):
        # A side of a fifth of the row, on two lanes: 20 px at 100, 42 at 210.
        side = 20 + 2 * index
        sizes.learn(square(30 + 80 * (index % 2) - side / 2, 100 + 10 * index, side))
    sizes.settle()
    assert sizes.vehicles_in(Piece(0, 60, 80, 100, 3200)) == pytest.approx(7.2, rel=0.01)
    # At row 50 it would be 10 px, half of the least that was seen; at row 80, 16 px, it is near it,
    # and that one is taken.
    assert sizes.vehicles_in(Piece(0, 10, 80, 50, 3200)) == 0
    assert sizes.vehicles_in(Piece(0, 40, 80, 80, 3200)) == pytest.approx(7.2, rel=0.01)
