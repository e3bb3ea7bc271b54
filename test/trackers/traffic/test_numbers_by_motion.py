# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Numbers of synthetic scenes by motion: what is no vehicle has none, and what is one has one.

The scenes have a road with lane marks, noise, and at most one vehicle, whose box is known exactly.
"""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

RATE = 25
WIDTH, HEIGHT = 240, 160
VEHICLE = cv2.GaussianBlur(
    np.random.default_rng(1).integers(150, 255, (26, 44, 3)).astype(np.uint8), (5, 5), 0
)


def road():
    rng = np.random.default_rng(0)
    ground = cv2.GaussianBlur(rng.uniform(60, 120, (HEIGHT, WIDTH, 3)), (7, 7), 0)
    ground[78:82] = 200
    ground[:30, 150:] = 170  # a wall in the sun
    return ground


def scene(lefts, change=lambda index, image: image):
    """Images with a vehicle at each left edge, where there is one, then changed as a whole."""
    rng = np.random.default_rng(2)
    for index, left in enumerate(lefts):
        image = road()
        if left is not None:
            shown = slice(max(left, 0), max(min(left + 44, WIDTH), 0))
            image[90:116, shown] = VEHICLE[:, shown.start - left : shown.stop - left]
        image = change(index, image) + rng.normal(0, 2, image.shape)
        yield np.clip(image, 0, 255).astype(np.uint8)


def followed(images):
    """Session of a run, numbers with their boxes by image, and what was detected in each."""
    session = TrafficSession(MultiVehicleTracker(), MotionDetector, frame_rate=RATE)
    boxes, blobs = [], []
    for index, image in enumerate(images):
        detector = session.detector
        before = session.detected.boxes
        estimates = session.feed(image, round(index * 1e9 / RATE))
        boxes.append({one.identity: one.box for one in estimates if one.identity})
        blobs.append(session.detected.boxes - before)
        assert session.detector is detector
    return session, boxes, blobs


def overlap(box, left):
    x = min(box.x + box.width, left + 44) - max(box.x, left)
    y = min(box.y + box.height, 116) - max(box.y, 90)
    shared = max(x, 0) * max(y, 0)
    return shared / (box.width * box.height + 44 * 26 - shared)


def test_a_vehicle_that_stands_at_first_and_drives_off_leaves_no_number_behind():
    lefts = [60] * 40 + [60 + 3 * k for k in range(45)] + [None] * 60
    _, boxes, blobs = followed(scene(lefts))
    numbers = set().union(*boxes)
    assert len(numbers) == 1
    late = boxes[75]
    assert overlap(*late.values(), lefts[75]) > 0.6
    # Its own length driven, then two searches for holes: from then on it is one blob.
    assert max(blobs[70:80]) == 1
    assert sum(blobs[95:]) == 0


def test_what_drives_over_a_hole_has_a_box_of_its_own():
    lefts = [100] * 25 + [100 + 6 * k for k in range(24)] + [4 * k - 44 for k in range(40)]
    _, boxes, _ = followed(scene(lefts))
    # Half over where the first one stood: joined to the hole it would be half as wide again.
    index = lefts.index(72)
    assert max(overlap(box, 72) for box in boxes[index].values()) > 0.75


def clock(index, image):
    """A clock in a corner, whose digits tick."""
    image = image.astype(np.uint8)
    image[140:] = 20
    text = f"16:06:{index // RATE % 60:02d}"
    return cv2.putText(image, text, (140, 155), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (255,) * 3, 2)


@pytest.mark.parametrize("start", [0, 7])
def test_a_clock_that_ticks_has_no_number(start):
    images = scene([None] * 240, lambda index, image: clock(index + start * RATE, image))
    _, boxes, blobs = followed(images)
    assert sum(blobs) > 100  # it is detected
    assert not set().union(*boxes)


@pytest.mark.parametrize("gain", [0.8, 1.2])
@pytest.mark.parametrize("offset", [0, 12])
def test_a_jump_of_the_exposure_gives_no_numbers_and_loses_none(gain, offset):
    lefts = [None] * 30 + [2 * k - 44 for k in range(70)]
    session, boxes, _ = followed(
        scene(lefts, lambda index, image: gain * image + offset if index >= 70 else image)
    )
    assert set().union(*boxes) == {1}
    assert session.detected.disturbed == 0
    assert overlap(boxes[95][1], lefts[95]) > 0.6


@pytest.mark.parametrize("rate", [-0.004, 0.004])
def test_a_slow_drift_of_the_exposure_gives_no_numbers(rate):
    lefts = [None] * 30 + [2 * k - 44 for k in range(70)]
    _, boxes, _ = followed(scene(lefts, lambda index, image: image * (1 + rate * index)))
    assert set().union(*boxes) == {1}
    assert overlap(boxes[95][1], lefts[95]) > 0.6
