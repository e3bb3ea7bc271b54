# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One number for one vehicle: those that reappear keep theirs, doubles have none."""

import numpy as np
import pytest
from traffic_samples import changed, together, track

from vehicle_pf_tracker.image.windows.box_colours import COLOUR_BINS
from vehicle_pf_tracker.trackers.traffic.identity import find_hidden, is_double, resume
from vehicle_pf_tracker.trackers.traffic.report import estimates_of

BOX = np.array([100.0, 100, 140, 130])
RED, BLUE = np.eye(COLOUR_BINS)[:2]


def confirmed(number, left, colours=RED, **facts):
    first = facts.pop("first", left)
    seen = (first, 100.0, first + 40.0, 130.0)
    return track(number, left, colours=colours, confirmed=True, first=seen, **facts)


def found_again(*tracks):
    """The row of the vehicle that the last of these tracks is."""
    every = together(*tracks)
    return find_hidden(every, len(every) - 1, every.confirmed)


def test_a_vehicle_that_reappears_a_little_off_is_the_hidden_one():
    hidden, new = confirmed(1, 100.0, undetected=20.0), confirmed(2, 130.0)
    both = together(hidden, changed(new, detection=new.edges))
    assert found_again(hidden, new) == 0
    one = resume(both, 0, 1).take(np.array([0]))
    assert one.latest.detection[0, 0] == pytest.approx(130)
    assert one.names.identity == 1
    assert one.edges[0, 0] == pytest.approx(130)
    assert one.detected


@pytest.mark.parametrize(
    "other",
    [
        confirmed(1, 100.0, undetected=2.0),
        confirmed(1, 300.0, undetected=20.0),
        confirmed(1, 100.0, BLUE, undetected=20.0),
        confirmed(1, 100.0, undetected=20.0, uncovered=0.2),
    ],
    ids=["just seen", "far away", "of another colour", "still behind another"],
)
def test_others_are_not_taken_for_it(other):
    assert found_again(other, confirmed(2, 130.0)) is None


def test_a_vehicle_confirmed_a_second_time_is_the_first_unless_there_were_two():
    ghost, born = confirmed(1, 100.0, undetected=20.0), confirmed(2, 115.0, age=12.0)
    assert found_again(ghost, born) == 0
    assert found_again(ghost, confirmed(2, 115.0, age=21.0)) is None  # detected beside it
    assert found_again(ghost, confirmed(2, 140.0, age=12.0)) is None  # near, not beside it
    both = resume(together(ghost, born), 0, 1)
    one, _ = estimates_of(both)
    assert (one.identity, one.joined) == (1, 2)


@pytest.mark.parametrize(
    ("age", "box", "expected"),
    [
        (23.0, (100.0, 100.0, 140.0, 130.0), 0),  # from three periods before
        (24.0, (119.0, 100.0, 159.0, 130.0), 0),  # from four, with most of the box in common
        (24.0, (120.0, 100.0, 160.0, 130.0), None),
    ],
    ids=["just before", "a second box of it", "beside it"],
)
def test_a_new_one_that_was_detected_beside_the_hidden_vehicle_is_another_one(age, box, expected):
    where = np.array([[100.0, 100.0, 140.0, 130.0]])
    hidden = changed(confirmed(1, 100.0, undetected=20.0), detection=where)
    new = track(2, 115.0, colours=RED, age=age, first=(115.0, 100.0, 155.0, 130.0))
    new = changed(new, detection=np.array([box]))
    assert found_again(hidden, new) == expected


@pytest.mark.parametrize(
    ("last", "first", "expected"),
    [(100.0, 186.0, 0), (100.0, 187.0, None), (52.0, 22.0, 0), (52.0, 21.0, None)],
    ids=["ahead", "too far ahead", "behind", "too far behind"],
)
def test_a_vehicle_that_was_first_seen_elsewhere_is_another_one(last, first, expected):
    # Predicted at 160 after 60 periods, and a third of the way there after 20, when the other one
    # came into view: at 120, or at 88. It may be 1 + 20 / 30 widths of 40 px off by then, 66.7 px.
    where = np.array([[last, 100.0, last + 40.0, 130.0]])
    hidden = changed(confirmed(1, 160.0, undetected=60.0), detection=where)
    new = confirmed(2, 165.0, age=40.0, first=first)
    assert found_again(hidden, new) == expected
    every = together(hidden, new)
    # The first shape may have been of several vehicles.
    assert find_hidden(every, 1, every.confirmed, are_shapes=True) == 0


def test_of_two_hidden_vehicles_the_nearer_one_has_come_back():
    far, near = (confirmed(1, left, undetected=20.0) for left in (80.0, 120.0))
    assert found_again(far, near, confirmed(3, 130.0)) == 1


@pytest.mark.parametrize(
    ("left", "facts", "double", "double_shape"),
    [
        (119, {}, True, True),
        (121, {}, False, False),
        (119, {"undetected": 1.0, "searched": 3}, True, False),
        (119, {"undetected": 4.0, "searched": 4}, False, False),
    ],
    ids=["most in common", "less in common", "missed for three images", "missed for four"],
)
def test_what_shares_most_of_its_box_with_a_recent_vehicle_is_its_double(
    left, facts, double, double_shape
):
    box = BOX + np.array([left - 100, 0] * 2)
    new = track(3, 100, detection=BOX)
    both = together(track(1, left, confirmed=True, detection=box, **facts), new)
    assert is_double(both, 1) is double
    assert is_double(both, 1, are_shapes=True) is double_shape
    unknown = together(track(2, left, detection=box, **facts), new)
    assert not is_double(unknown, 1)
