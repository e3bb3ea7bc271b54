# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Compressed images of another size: decoded only when a second one agrees."""

import numpy as np
import pytest
from session_samples import PERIOD_NS, session
from street import Street

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.continuity import StrayImageError


class Coded:
    """A coded frame that counts how often it is decoded."""

    def __init__(self, frame, *, is_damaged=False):
        self.frame, self.is_damaged, self.count = frame, is_damaged, 0
        self.size = frame.shape[1], frame.shape[0]

    def decode(self):
        self.count += 1
        if self.is_damaged:
            raise InputError("it is damaged")
        return self.frame


def larger(street, t):
    return np.pad(street.frame(t), ((0, 10), (0, 0), (0, 0)))


@pytest.fixture
def street():
    return Street()


@pytest.fixture
def tracking(street):
    at_work = session(street.box(0))
    for t in range(3):
        at_work.feed(street.frame(t), (t + 1) * PERIOD_NS)
    return at_work


def test_a_stray_is_not_decoded(street, tracking):
    stray = Coded(np.zeros((5, 9, 3), np.uint8))
    with pytest.raises(StrayImageError, match="9x5 px among images of 200x120 px"):
        tracking.feed(stray, 4 * PERIOD_NS)
    assert tracking.feed(street.frame(4), 5 * PERIOD_NS) is not None
    assert stray.count == 0


def test_two_that_agree_give_what_decoded_ones_give(street, tracking):
    decoded = session(street.box(0))
    for t in range(3):
        decoded.feed(street.frame(t), (t + 1) * PERIOD_NS)
    first, second = Coded(larger(street, 3)), Coded(larger(street, 4))
    for at_work, images in (
        (tracking, [first, second, larger(street, 5)]),
        (decoded, [larger(street, t) for t in (3, 4, 5)]),
    ):
        with pytest.raises(StrayImageError):
            at_work.feed(images[0], 4 * PERIOD_NS)
        at_work.estimates = [
            at_work.feed(image, t * PERIOD_NS) for t, image in enumerate(images[1:], 5)
        ]
    assert (first.count, second.count) == (1, 1)
    pairs = zip(tracking.estimates, decoded.estimates, strict=True)
    assert all(one.position == other.position for one, other in pairs)


def test_a_damaged_one_is_rejected_and_the_next_believed(street, tracking):
    with pytest.raises(StrayImageError):
        tracking.feed(Coded(larger(street, 3), is_damaged=True), 4 * PERIOD_NS)
    with pytest.raises(InputError, match="it is damaged"):
        tracking.feed(Coded(larger(street, 4), is_damaged=True), 5 * PERIOD_NS)
    assert tracking.feed(Coded(larger(street, 5)), 6 * PERIOD_NS).regime == "start"


def test_a_damaged_first_one_is_left_out(street, tracking):
    with pytest.raises(StrayImageError):
        tracking.feed(Coded(larger(street, 3), is_damaged=True), 4 * PERIOD_NS)
    assert tracking.feed(Coded(larger(street, 4)), 5 * PERIOD_NS).regime == "start"
