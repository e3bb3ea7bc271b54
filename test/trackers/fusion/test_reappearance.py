# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What comes out on the heading of a hidden vehicle: the vehicle itself, or a stranger."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.perspective import PerspectiveMotion, Sighting
from vehicle_pf_tracker.trackers.fusion.reappearance import Candidate, Reappearance

SIZE = np.array([20.0, 12.0])
LAST = np.array([100.0, 60.0])
MOTION = PerspectiveMotion(LAST, np.array([2.0, 0.0]), 0.0)
"""Motion to the right; the predicted diagonal is 23 px."""


def judged(response=0.9, paint=0.5):
    """The filter and the paint agree, in the middle of each outline."""
    return lambda sides, size: Candidate(sides.mean(axis=0), size, response, paint)


def box(x, y, width, height):
    middle = np.array([x, y])
    half = np.array([width, height]) / 2
    return np.stack([middle - half, middle + half])


def driving(time, ahead=20.0, aside=0.0, speed=2.0, scale=1.0, out=10):
    """An outline that drives on `ahead` of the predicted path, in the open from frame `out` on."""
    x = LAST[0] + 20 + ahead + speed * (time - 10)
    return box(x, LAST[1] + aside, *(scale * SIZE)) if time >= out else None


def first_proof(outline, judge=None, frames=40):
    """Frame in which an outline is proven to be the vehicle's, and its velocity; None if never."""
    hidden = Reappearance(Sighting(0.0, LAST, SIZE), MOTION, 0.0)
    for time in range(1, frames):
        sides = outline(time)
        boxes = np.empty((0, 2, 2)) if sides is None else sides[np.newaxis]
        hidden = hidden.aged(1.0)
        if hidden.is_due:
            hidden = hidden.observed(boxes, judge or judged())
        if hidden.vehicle is not None:
            return time, hidden.vehicle[1]
    return None


def test_what_drives_on_ahead_of_the_prediction_at_twice_the_size_is_the_vehicle():
    time, velocity = first_proof(lambda time: driving(time, speed=4.0, scale=1.8))
    # Seen in frame 11, the first second one; eight frames prove that it drives on, of which the
    # last is looked at too late by one, and three in a row that it is the vehicle.
    assert time == 11 + 7 + 1 + 2
    assert velocity == pytest.approx([4.0, 0.0])


@pytest.mark.parametrize(
    ("outline", "judge"),
    [
        (lambda time: driving(time, out=1), judged()),
        (lambda time: driving(time, aside=max(40.0 - 3.0 * (time - 10), 0.0)), judged()),
        (lambda time: driving(time, ahead=60.0), judged()),
        (lambda time: driving(time, aside=35.0), judged()),
        (lambda time: driving(time, speed=0.5), judged()),
        (lambda time: driving(time, ahead=30.0, speed=-2.0), judged()),
        (lambda time: driving(time, scale=0.4), judged()),
        (lambda time: driving(time, scale=2.5), judged()),
        (driving, judged(response=0.6)),
        (driving, judged(paint=0.05)),
    ],
    ids=[
        "in view before", "from another lane", "far ahead", "on the next lane", "too slow",
        "against the heading", "too small", "too large", "unknown to the filter", "of other paint",
    ],
)  # fmt: skip
def test_a_stranger_is_not_taken(outline, judge):
    assert first_proof(outline, judge) is None


def test_only_what_drives_on_is_judged():
    calls = []

    def judge(sides, size):
        calls.append(sides)
        return judged()(sides, size)

    assert first_proof(lambda time: box(130, 60, 20, 12), judge) is None
    assert not calls


def test_an_outline_that_jumps_is_another_one():
    jumps = first_proof(lambda time: driving(time, ahead=20.0 if time < 15 else -10.0))
    assert jumps is not None and jumps[0] == 15 + 7 + 1 + 2


def test_outlines_are_looked_at_in_every_second_frame_until_one_drives_on():
    hidden, looks = Reappearance(Sighting(0.0, LAST, SIZE), MOTION, 0.0), []
    for time in range(1, 24):
        hidden = hidden.aged(1.0)
        if hidden.is_due:
            looks.append(time)
            sides = driving(time)
            boxes = np.empty((0, 2, 2)) if sides is None else sides[np.newaxis]
            hidden = hidden.observed(boxes, judged())
    assert looks == [*range(1, 20, 2), 20, 21, 22, 23]


def test_a_size_ahead_of_the_prediction_is_another_in_its_lane():
    """After 20 frames it is expected 40 px ahead; a size is 15.5 px."""
    hidden = Reappearance(Sighting(0.0, LAST, SIZE), MOTION, 20.0)
    positions = LAST + np.array([[20.0, 5.0], [55.0, -5.0], [56.0, -5.0]])
    assert hidden.excludes(positions).tolist() == [False, False, True]
    # What is behind is excluded, too (`behind`).
    assert hidden.excludes(LAST - np.array([8.0, 0.0]))
    standing = hidden._replace(motion=PerspectiveMotion(LAST, np.zeros(2), 0.0))
    assert not standing.excludes(positions).any()


@pytest.mark.parametrize(
    ("moving", "is_covered"),
    [([], True), ([box(102, 60, 18, 10)], False), ([box(160, 60, 20, 12)], True)],
    ids=["nothing", "the vehicle itself", "another ahead"],
)
def test_it_is_covered_where_nothing_moves_at_the_predicted_place(moving, is_covered):
    hidden = Reappearance(Sighting(0.0, LAST, SIZE), MOTION, 0.0).aged(1.0)
    assert not hidden.is_covered
    boxes = np.array(moving).reshape(-1, 2, 2)
    assert hidden.observed(boxes, judged()).is_covered is is_covered
