# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detectors that look at some of the images only."""

import numpy as np
import pytest

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.following.paced_detector import PacedDetector

FRAME = np.zeros((9, 9, 3), np.uint8)


class Blind:
    disturbed, is_blind = True, True

    def detect(self, frame, tracks=(), period=0.0):
        return Detections.make([[1, 2, 30, 40]])


def test_a_detector_looks_at_every_third_image_and_says_whether_it_looked():
    paced = PacedDetector(Blind(), lambda: 3)
    seen = [(len(paced.detect(FRAME)), paced.disturbed, paced.is_blind) for _ in range(7)]
    looked, passed = (1, True, True), (0, False, True)
    assert seen == [looked, passed, passed, looked, passed, passed, looked]
    assert paced.found == 1
    assert paced.seconds > 0


def test_a_detector_is_told_the_time_since_it_looked():
    told = []
    blind = Blind()
    blind.detect = lambda *given: told.append(given[2]) or Detections.make([[1, 2, 30, 40]])
    paced = PacedDetector(blind, lambda: 3)
    for _ in range(7):
        paced.detect(FRAME, (), 0.1)
    assert told == pytest.approx([0.1, 0.3, 0.3])


@pytest.mark.parametrize(
    ("network", "others", "rate", "every"),
    [
        (0.018, 0.005, 30, 1),
        (0.018, 0.015, 30, 2),  # 11.7 ms are left of 26.7
        (0.018, 0.020, 10, 1),
        (0.2, 0.1, 30, 3),  # too slow for any: a tenth of a second, no longer
        (0.2, 0.1, 2, 1),
    ],
)
def test_the_rate_of_the_images_chooses_how_often_it_looks(network, others, rate, every):
    paced, fixed = PacedDetector(Blind(), lambda: 0), PacedDetector(Blind(), lambda: 2)
    for detector in (paced, fixed):
        for _ in range(100):
            looked = len(detector.detect(FRAME)) > 0
            detector.seconds = network
            detector.pace(others + looked * network, 1 / rate)
    assert (paced.every, fixed.every) == (every, 2)


def test_a_change_of_the_parameter_counts_from_the_next_image_on():
    wanted = [3]
    paced = PacedDetector(Blind(), lambda: wanted[0])
    assert [len(paced.detect(FRAME)) for _ in range(2)] == [1, 0]
    wanted[0] = 1
    assert [len(paced.detect(FRAME)) for _ in range(2)] == [1, 1]
