# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that stand when the camera is switched on, and drive off or not."""

from dataclasses import replace

import numpy as np
import pytest

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.parameters import IGNORE_STANDING, TrafficParameters
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

GROUND = np.random.default_rng(0).integers(90, 130, (240, 640, 3)).astype(np.uint8)
IGNORED = TrafficParameters()
IGNORED = replace(IGNORED, birth=replace(IGNORED.birth, standing=IGNORE_STANDING))


def reported(score, *, stands=0, drives=0.0, parameters=None, shape=False, images=240, seed=None):
    """Images until a vehicle that stands for so many, then drives so many px each, is reported."""
    tracker, rng = MultiVehicleTracker(parameters), np.random.default_rng(seed)
    for index in range(images):
        left = 60 + drives * max(index - stands, 0)
        if left > 590:
            break
        box = np.array([left, 100, 40, 30]) + (0 if seed is None else rng.normal(0, 1, 4))
        scores = None if score is None else [score]
        detections = replace(Detections.make([box], scores), are_shapes=shape)
        if any(one.identity for one in tracker.step(GROUND, detections)):
            return index + 1
    return None


@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("score", [0.75, 0.9, 0.97])
def test_what_a_detector_is_sure_of_is_reported_within_a_second_though_it_stands(score, seed):
    assert reported(score, images=30, seed=seed)


@pytest.mark.parametrize("score", [0.0, 0.1, 0.37, 0.5])
def test_what_it_is_not_sure_of_has_to_drive(score):
    assert reported(score) is None
    assert reported(score, drives=2.0)


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_without_scores_what_is_detected_in_each_image_is_reported_within_a_second(seed):
    """Two to one, less the doubt: log 2 - .5 = .193, of which 21 are more than 4."""
    assert reported(None, images=30, seed=seed) == 21


def test_a_shape_that_stands_is_no_vehicle_however_high_its_score():
    assert reported(0.9, shape=True) is None


@pytest.mark.parametrize("stands", [60, 150])
@pytest.mark.parametrize("score", [0.2, 0.55, 0.9, None])
def test_having_stood_makes_nothing_less_likely_once_it_drives(score, stands):
    at_once = reported(score, drives=2.0)
    assert reported(score, stands=stands, drives=2.0) <= stands + at_once


def test_who_counts_only_what_moves_may_ignore_what_stands():
    assert reported(0.9, parameters=IGNORED) is None
    assert 100 < reported(0.9, stands=100, drives=2.0, parameters=IGNORED) <= 112


def test_what_a_detector_is_sure_of_where_nothing_ever_drove_is_not_reported_for_long():
    """A stall of a fair, say: its score is high, but so were those of all that ended there."""
    tracker, rng = MultiVehicleTracker(), np.random.default_rng(0)
    for _ in range(600):
        boxes = [(*rng.uniform((0, 0), (600, 60)), 40, 30)]  # anywhere above the road
        tracker.step(GROUND, Detections.make(boxes, [rng.uniform(0.6, 0.85)]))
    before = tracker.last_identity
    for _ in range(60):
        tracker.step(GROUND, Detections.make([(300, 20, 40, 30)], [0.75]))
    assert tracker.last_identity == before
    assert reported(0.75)
