# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The way of a hidden vehicle: where it cannot be, and whether something covers it."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.hidden_way import HiddenWay
from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting

SIZE = np.array([20.0, 12.0])
LAST = np.array([100.0, 60.0])
MOTION = PerspectiveMotion(LAST, np.array([2.0, 0.0]), 0.0)


def way(age=0.0):
    return HiddenWay(Sighting(0.0, LAST, SIZE), MOTION, age)


def box(x, y, width, height):
    middle = np.array([x, y])
    half = np.array([width, height]) / 2
    return np.stack([middle - half, middle + half])


def test_outlines_are_looked_at_in_every_second_frame():
    hidden, looks = way(), []
    for time in range(1, 8):
        hidden = hidden.aged(1.0)
        if hidden.is_due:
            looks.append(time)
            hidden = hidden.looked(np.empty((0, 2, 2)))
    assert looks == [1, 3, 5, 7]
    assert hidden.place[0] == pytest.approx(LAST + np.array([14.0, 0.0]))


def test_a_size_ahead_of_the_prediction_is_another_in_its_lane():
    """After 20 frames it is expected 40 px ahead; a size is 15.5 px."""
    hidden = way(20.0)
    positions = LAST + np.array([[20.0, 5.0], [55.0, -5.0], [56.0, -5.0]])
    assert hidden.excludes(positions).tolist() == [False, False, True]
    # What is behind is excluded, too (`behind`).
    assert hidden.excludes(LAST - np.array([8.0, 0.0]))
    standing = hidden._replace(motion=PerspectiveMotion(LAST, np.zeros(2), 0.0))
    assert not standing.excludes(positions).any()


@pytest.mark.parametrize(
    ("moving", "is_covered"),
    [
        ([], True),
        ([box(102, 60, 18, 10)], False),
        ([box(160, 60, 20, 12)], True),
        ([box(102, 60, 7, 8)], True),
        ([box(117, 60, 21, 12)], False), ([box(118, 60, 21, 12)], True),
        ([box(160, 60, 20, 12), box(102, 72, 20, 19)], False),
    ],
    ids=[
        "nothing", "the vehicle itself", "another ahead", "a piece, less than a quarter of 240 px",
        "in the middle half, which ends at 107", "beside it", "one of two",
    ],
)  # fmt: skip
def test_it_is_covered_where_nothing_moves_at_the_predicted_place(moving, is_covered):
    hidden = way().aged(1.0)
    assert not hidden.is_covered
    assert hidden.looked(np.array(moving).reshape(-1, 2, 2)).is_covered is is_covered
