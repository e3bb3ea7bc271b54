# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What the tracker says of one made road, to the tenth of a pixel: a change of form changes none.

Two lanes each way, a lorry that hides cars, a sign, misses, false alarms and noisy boxes.
"""

import numpy as np
import pytest

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

WIDTH, HEIGHT, FRAMES = 400, 240, 90
SIGN = (180, 70, 34, 100)
CARS = [  # left edge at first, lower edge, speed px per image, width, height
    (-40, 110, 4.0, 34, 24), (-140, 112, 4.2, 36, 26), (-60, 150, 3.0, 90, 60),
    (-30, 140, 3.6, 40, 28), (400, 200, -3.4, 52, 36), (470, 202, -3.8, 50, 36),
]  # fmt: skip
PAINT = np.random.default_rng(5).integers(0, 255, (6, 60, 90, 3)).astype(np.uint8)
GROUND = np.random.default_rng(6).integers(90, 120, (HEIGHT, WIDTH, 3)).astype(np.uint8)

EXPECTED = {
    30: [
        (1, "TRACKING", 74.2, 120.7, 89.2),
        (2, "TRACKING", 323.8, 182.6, 52.1),
        (3, "TRACKING", 374.6, 183.0, 25.0),
    ],
    55: [
        (1, "TRACKING", 150.2, 119.3, 90.7),
        (2, "TRACKING", 239.4, 181.6, 52.3),
        (3, "TRACKING", 286.2, 183.3, 50.3),
        (4, "TRACKING", 109.4, 99.0, 36.1),
        (5, "OCCLUDED", 196.1, 96.8, 34.0),
    ],
    85: [
        (1, "TRACKING", 239.7, 120.4, 90.3),
        (2, "TRACKING", 136.7, 181.4, 51.9),
        (3, "TRACKING", 171.6, 183.9, 49.9),
        (4, "TRACKING", 235.7, 98.5, 36.0),
        (5, "TRACKING", 317.4, 97.9, 33.8),
        (6, "TRACKING", 295.9, 126.1, 39.8),
    ],
}
"""Identity, mode, centre and width of every numbered vehicle, by frame."""


def images():
    """Frames with the boxes and scores that a detector gives."""
    rng = np.random.default_rng(7)
    for index in range(FRAMES):
        frame, seen = GROUND.copy(), []
        for number in np.argsort([car[1] for car in CARS]).tolist():
            left, bottom, speed, width, height = CARS[number]
            x, y = round(left + speed * index), bottom - height
            shown = slice(*np.clip((x, x + width), 0, WIDTH).tolist())
            frame[y:bottom, shown] = PAINT[number, :height, : shown.stop - shown.start]
            hidden = SIGN[0] - 10 < x + width / 2 < SIGN[0] + SIGN[2] + 10 and bottom < 171
            if shown.stop - shown.start > 12 and not hidden and rng.uniform() > 0.05:
                box = np.array([shown.start, y, shown.stop - shown.start, height])
                seen.append((*(box + rng.normal(0, 0.8, 4)), rng.beta(8, 3)))
        if rng.uniform() < 0.3:
            seen.append((*rng.uniform((0, 60), (360, 180)), 30.0, 20.0, rng.beta(4, 8)))
        x, y, width, height = SIGN
        frame[y : y + height, x : x + width] = 40
        rows = np.array(seen).reshape(-1, 5)
        yield frame, Detections.make(rows[:, :4], rows[:, 4])


def said():
    tracker, every = MultiVehicleTracker(), {}
    for index, (frame, detections) in enumerate(images()):
        estimates = tracker.step(frame, detections)
        if index in (30, 55, 85):
            every[index] = [
                (one.identity, one.mode.value, *np.round(one.box.centre, 1).tolist(),
                 round(one.box.width, 1))
                for one in estimates if one.identity
            ]  # fmt: skip
    return every


def test_a_made_road_is_followed_as_it_was_before():
    found = said()
    assert {index: [row[:2] for row in rows] for index, rows in found.items()} == {
        index: [row[:2] for row in rows] for index, rows in EXPECTED.items()
    }
    for index, rows in EXPECTED.items():
        places = np.array([row[2:] for row in found[index]])
        assert places == pytest.approx(np.array([row[2:] for row in rows]), abs=0.15)
