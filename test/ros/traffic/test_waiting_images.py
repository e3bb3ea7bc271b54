# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import pytest

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.ros.traffic.waiting_images import MOST_WAITING, WaitingImages

WAIT = 0.5
SEEN = Detections.make([[1, 2, 3, 4]])
NOTHING = Detections.none()


class Clock:
    now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def images(clock):
    return WaitingImages(clock)


def show(images, *stamps):
    for stamp in stamps:
        images.add_image(f"image {stamp}", stamp, WAIT)


def passed(images, every=1):
    return [(int(image.split()[1]), found) for image, found in images.ready(every)]


def test_an_image_waits_for_the_detections_of_its_stamp(images):
    show(images, 10)
    assert passed(images) == []
    images.add_detections(10, SEEN)
    assert passed(images) == [(10, SEEN)]
    assert (images.matched, images.missed, len(images)) == (1, 0, 0)


def test_nothing_seen_is_an_answer(images):
    show(images, 10)
    images.add_detections(10, NOTHING)
    assert passed(images) == [(10, NOTHING)]


def test_an_answer_that_cannot_be_used_ends_the_waiting(images):
    show(images, 10)
    images.add_detections(10, None)
    assert passed(images) == [(10, None)]
    assert images.missed == 0


def test_detections_may_come_before_their_image(images):
    images.add_detections(10, SEEN)
    show(images, 10)
    assert passed(images) == [(10, SEEN)]


def test_only_the_exact_stamp_matches(images):
    show(images, 10)
    images.add_detections(11, SEEN)
    assert passed(images) == []


def test_an_image_waits_no_longer_than_it_may(images, clock):
    show(images, 10)
    clock.now += WAIT - 0.01
    assert passed(images) == []
    clock.now += 0.02
    assert passed(images) == [(10, None)]
    images.add_detections(10, SEEN)
    assert (images.missed, images.late, passed(images)) == (1, 1, [])


def test_images_stay_in_order_and_a_later_answer_frees_those_before(images):
    show(images, 10, 20, 30, 40)
    images.add_detections(30, SEEN)
    assert passed(images) == [(10, None), (20, None), (30, SEEN)]
    images.add_detections(40, NOTHING)
    assert passed(images) == [(40, NOTHING)]


def test_no_more_images_wait_than_memory_is_for(images):
    show(images, *range(MOST_WAITING))
    assert passed(images) == []
    show(images, MOST_WAITING, MOST_WAITING + 1)
    assert passed(images) == [(0, None), (1, None)]
    assert len(images) == MOST_WAITING


def test_images_between_those_that_the_detector_answers_do_not_wait(images):
    found = []
    for stamp in range(9):
        show(images, stamp)
        if stamp % 3 == 0:
            assert passed(images, 3) == []
            images.add_detections(stamp, SEEN, 3)
        found += passed(images, 3)
    assert [stamp for stamp, _ in found] == list(range(9))
    assert [stamp for stamp, one in found if one is SEEN] == [0, 3, 6]
    assert images.missed == 0


def test_the_step_of_the_detector_is_found_where_it_answers_other_images(images, clock):
    """It began with the third image; the first waits in vain, and from then on it is known."""
    show(images, 0)
    clock.now += 1
    assert passed(images, 3) == [(0, None)]
    show(images, 1, 2)
    images.add_detections(2, SEEN, 3)
    assert passed(images, 3) == [(1, None), (2, SEEN)]
    show(images, 3, 4)
    assert passed(images, 3) == [(3, None), (4, None)]
    show(images, 5)
    assert passed(images, 3) == []


def test_equal_stamps_are_answered_one_after_the_other(images):
    show(images, 0, 0)
    images.add_detections(0, SEEN)
    assert passed(images) == [(0, SEEN)]
    images.add_detections(0, NOTHING)
    assert passed(images) == [(0, NOTHING)]


def test_detections_that_never_match_are_counted_and_do_not_pile_up(images):
    for stamp in range(1000, 2000):
        images.add_detections(stamp, SEEN)
    assert images.unmatched == 900
    assert images.remembered == 100


def test_what_was_passed_on_is_not_remembered_for_ever(images, clock):
    for stamp in range(1000):
        show(images, stamp)
        clock.now += 1
        assert passed(images) == [(stamp, None)]
    assert images.remembered == 100
    images.clear()
    assert len(images) == images.remembered == 0
