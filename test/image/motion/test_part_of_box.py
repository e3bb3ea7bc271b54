# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of a box that move, on masks drawn by hand."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.part_of_box import box_in, mostly_inside, part_of

BOX = slice(4, 14), slice(10, 30)
"""Ten rows and twenty columns."""


def mask(*pieces):
    """A mask of 20 rows and 40 columns, and the bounds of its pieces."""
    moving = np.zeros((20, 40), np.uint8)
    for left, top, right, bottom in pieces:
        moving[top:bottom, left:right] = 1
    return moving, np.array(pieces, float).reshape(-1, 2, 2)


def test_a_piece_counts_as_far_as_it_is_in_the_box():
    """Columns 25 to 29 of twenty, rows 4 to 13 of ten: a quarter, and three quarters are bare."""
    moving, pieces = mask((25, 0, 35, 20))
    part = part_of(moving, BOX, pieces)
    assert part.share == pytest.approx(0.25)
    assert part.bare == pytest.approx(0.75)
    assert part.sides.tolist() == [[25, 4], [30, 14]]


def test_what_else_moves_takes_no_share_and_leaves_no_end_bare():
    moving, pieces = mask((10, 4, 15, 14), (17, 4, 30, 14))
    part = part_of(moving, BOX, pieces[:1])
    assert (part.share, part.bare) == (0.25, 0.0)
    assert part_of(moving, BOX, pieces[:0]) is None


def test_one_pixel_of_ten_leaves_an_end_bare():
    moving, pieces = mask((10, 4, 15, 14), (29, 4, 30, 5))
    assert part_of(moving, BOX, pieces[:1]).bare == pytest.approx(0.75)


@pytest.mark.parametrize(("right", "belongs"), [(19, True), (21, True), (22, False)])
def test_a_piece_belongs_to_a_box_with_half_of_its_bounds(right, belongs):
    """A box from 0 to 10: pieces from 0 on that are 18, 20 and 21 long have 10 inside."""
    piece = np.array([[[0.0, 0.0], [right - 1.0, 8.0]]])
    assert bool(len(mostly_inside(piece, np.array([5.0, 4.0]), np.array([5.0, 4.0])))) == belongs


@pytest.mark.parametrize(
    ("low", "high", "rows", "columns"),
    [
        ((9.5, 3.2), (20.1, 8.0), (3, 8), (9, 21)),
        ((-5.0, -5.0), (3.0, 50.0), (0, 20), (0, 3)),
        ((60.0, 3.0), (70.0, 8.0), (3, 8), (40, 40)),
    ],
)
def test_a_box_is_cut_to_the_image(low, high, rows, columns):
    found = box_in((20, 40), np.array(low), np.array(high))
    assert [(each.start, each.stop) for each in found] == [rows, columns]
