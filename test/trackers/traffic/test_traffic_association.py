# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Costs of pairs, their assignment, and overlaps, with hand numbers."""

import numpy as np
import pytest
from traffic_samples import track

from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import areas, clipped, inside_image, overlaps
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.association import (
    GATE,
    FrameDetections,
    assign,
    edge_costs,
    is_double,
    pair_costs,
)
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins
from vehicle_pf_tracker.trackers.traffic.detection_evidence import DetectionEvidence
from vehicle_pf_tracker.trackers.traffic.parameters import DetectionParameters

BOX = np.array([10.0, 10, 50, 40])


def test_a_cost_is_the_squared_distance_in_standard_deviations():
    costs = edge_costs(BOX[np.newaxis], np.full((1, 4), 2.0), BOX[np.newaxis] + (2, 0, 2, -2))
    assert costs == pytest.approx(np.array([[3.0]]))


def test_a_part_costs_what_is_missing_not_its_distance():
    # The lower half is hidden: 15 px inward are 56 squared deviations.
    half = BOX - (0, 0, 0, 15)
    costs = edge_costs(BOX[np.newaxis], np.full((1, 4), 2.0), half[np.newaxis])
    assert costs == pytest.approx(np.array([[3 + 12 * 0.5]]))


def test_a_sliver_is_no_part():
    sliver = BOX - (0, 0, 0, 28)
    assert edge_costs(BOX[np.newaxis], np.full((1, 4), 2.0), sliver[np.newaxis]) == 14**2


def test_the_assignment_is_the_cheapest_of_all_and_below_the_gate():
    assert assign(np.array([[1.0, 2.0], [2.0, 29.0]])) == [(0, 1), (1, 0)]
    assert assign(np.array([[1.0, 40.0], [40.0, 40.0]])) == [(0, 0)]
    assert assign(np.empty((0, 3))) == []


def test_overlaps():
    others = np.array([[30.0, 10, 70, 40], [60, 60, 70, 70]])
    assert intersections(BOX, others).tolist() == [600, 0]
    assert overlaps(BOX, others)[0] == pytest.approx(600 / 1800)
    assert areas(BOX) == 1200
    assert inside_image(BOX, (30, 240)) == 0.5
    assert clipped(np.array([[-5.0, 5, 20, 300]]), (100, 240)).tolist() == [[0, 5, 20, 240]]
    assert clipped(np.array([[200.0, 5, 220, 30]]), (100, 240)).tolist() == [[99, 5, 100, 30]]


@pytest.mark.parametrize(
    ("left", "facts", "double"),
    [(119, {}, True), (121, {}, False), (119, {"undetected": 1.0}, False)],
)
def test_what_shares_most_of_its_box_with_a_detected_vehicle_is_its_double(left, facts, double):
    new, box = track(3, 100, detection=BOX), BOX + np.array([left - 100, 0] * 2)
    other = track(1, left, confirmed=True, detection=box, **facts)
    assert is_double(new, [new, other]) is double
    assert not is_double(new, [new, track(2, left, detection=box)])  # new as well


@pytest.mark.parametrize("log_odds", [1.0, -1.0])
def test_a_likely_vehicle_that_overlaps_by_half_may_be_one_whose_drive_was_wrong(log_odds):
    sure = track(1, 100)
    sure.state.covariance *= 1e-4
    boxes = Detections.make([(106, 104, 40, 30)], [0.8])
    frame = np.zeros((240, 320, 3), np.uint8)
    found = FrameDetections(boxes, DetectionEvidence(), ColourBins(frame), (320, 240))
    found.log_odds = np.array([log_odds])
    settings = DetectionParameters(edge_noise=0.02)
    cost, _ = pair_costs([sure], found, [0], settings)
    assert (cost < GATE).all() == (log_odds > 0)


def test_the_log_odds_of_a_pair_fall_with_its_distance_and_with_false_alarms_there():
    evidence, vehicle = DetectionEvidence(), track(1, 100.0)
    frame = np.zeros((240, 320, 3), np.uint8)

    def odds(left):
        boxes = Detections.make([(left, 100, 40, 30)], [0.8])
        found = FrameDetections(boxes, evidence, ColourBins(frame), (320, 240))
        return float(pair_costs([vehicle], found, [0], DetectionParameters())[1][0, 0])

    before = odds(100)
    assert before > 2
    assert odds(115) < 0
    sample = evidence.samples(vehicle.state.edges[np.newaxis], np.ones(1), (320, 240))[0]
    for _ in range(30):
        evidence.look()
        evidence.learn(sample, False)
    assert odds(100) < before - 2
