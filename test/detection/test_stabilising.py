# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images of a camera that shakes, moved to where the first one was taken."""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.detection.stabilising import Stabiliser

GROUND = cv2.resize(
    np.random.default_rng(2).integers(40, 200, (36, 48, 3)).astype(np.uint8), (384, 288)
)


def shown(dx, dy, car=None):
    """The image of a camera that is moved by (dx, dy) px, with a car at a place of the ground."""
    ground = GROUND.copy()
    if car is not None:
        x, y = car
        ground[y : y + 30, x : x + 60] = 250
    return np.ascontiguousarray(ground[20 + dy : 260 + dy, 30 + dx : 350 + dx])


def test_a_shaken_image_is_moved_back():
    stabiliser = Stabiliser()
    stabiliser.stabilise(shown(0, 0))
    image, seen = stabiliser.stabilise(shown(4, -3))
    assert seen[:, :-5].any()
    inner = (slice(10, -10), slice(10, -10))
    assert np.abs(image[inner].astype(int) - shown(0, 0)[inner]).mean() < 2
    box = np.array([[100.0, 90.0, 140.0, 120.0]])
    assert stabiliser.to_reference(box)[0] == pytest.approx((104, 87, 144, 117), abs=0.3)
    assert stabiliser.from_reference(stabiliser.to_reference(box)) == pytest.approx(box)


def test_the_image_of_a_standing_camera_is_left_as_it_is():
    stabiliser = Stabiliser()
    for index in range(40):
        frame = shown(0, 0, (30 + 5 * index, 100))
        image, seen = stabiliser.stabilise(frame)
        assert image is frame
        assert seen is None


def test_an_image_without_a_corner_is_taken_as_it_is():
    stabiliser, black = Stabiliser(), np.zeros((48, 64, 3), np.uint8)
    assert [stabiliser.stabilise(black)[1] for _ in range(3)] == [None] * 3


def test_what_moves_is_found_before_a_shaking_camera_and_nothing_else():
    detector, rng = MotionDetector(), np.random.default_rng(1)
    shakes = rng.integers(-5, 6, (60, 2)).tolist()
    for dx, dy in shakes[:30]:
        detector.detect(shown(dx, dy))
    found = []
    for index, (dx, dy) in enumerate(shakes[30:]):
        left = 60 + 6 * index
        boxes = detector.detect(shown(dx, dy, (left, 120))).boxes
        found.append(len(boxes))
        expected = (left - 30 - dx, 100 - dy, 60, 30)
        assert min(np.abs(box - expected).max() for box in boxes) < 4
    assert np.mean(found) < 1.3
