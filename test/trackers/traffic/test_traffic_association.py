# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Costs of pairs and their assignment, with hand numbers."""

from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import candidates_of, changed, step_of, together, track

from vehicle_pf_tracker.core.overlaps import clipped
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.association import (
    GATE,
    assigned,
    birth_odds,
    edge_costs,
    pair_costs,
)
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.candidates import weigh
from vehicle_pf_tracker.trackers.traffic.detection_evidence import (
    DetectionEvidence,
    Sample,
    places_of,
)
from vehicle_pf_tracker.trackers.traffic.prediction import driven
from vehicle_pf_tracker.trackers.traffic.state import Experience

SIZE = (320, 240)
MEASUREMENT = MeasurementModel(SIZE, 0.05)
ONLY = np.array([0])
BOX = np.array([10.0, 10, 50, 40])


def test_a_cost_is_the_squared_distance_in_standard_deviations():
    costs = edge_costs(BOX[np.newaxis], np.full((1, 4), 2.0), BOX[np.newaxis] + (2, 0, 2, -2))
    assert costs == pytest.approx(np.array([3.0]))


def test_a_part_costs_what_is_missing_not_its_distance():
    # The lower half is hidden: 15 px inward are 56 squared deviations.
    half = BOX - (0, 0, 0, 15)
    costs = edge_costs(BOX[np.newaxis], np.full((1, 4), 2.0), half[np.newaxis])
    assert costs == pytest.approx(np.array([3 + 12 * 0.5]))


def test_a_sliver_is_no_part():
    sliver = BOX - (0, 0, 0, 28)
    assert edge_costs(BOX[np.newaxis], np.full((1, 4), 2.0), sliver[np.newaxis]) == 14**2


def test_the_assignment_is_the_cheapest_of_all_and_below_the_gate():
    assert pairs([[1.0, 2.0], [2.0, 29.0]]) == [(7, 6), (8, 5)]
    assert pairs([[1.0, 40.0], [40.0, 40.0]]) == [(7, 5)]
    assert pairs(np.empty((0, 3))) == []


def pairs(costs):
    """Pairs of tracks 7 and 8 with detections 5 and 6."""
    costs = np.array(costs)
    rows, columns, fits = assigned(np.array([7, 8]), np.array([5, 6]), costs, -costs)
    assert len(fits) == len(rows)
    return list(zip(rows.tolist(), columns.tolist(), strict=True))


@pytest.mark.parametrize("log_odds", [1.0, -1.0])
def test_a_likely_vehicle_that_overlaps_by_half_may_be_one_whose_drive_was_wrong(log_odds):
    sure = track(1, 100)
    sure = changed(sure, covariance=sure.drives.gaussians.covariance * 1e-4)
    boxes = Detections.make([(106, 104, 40, 30)], [0.8])
    candidates = weigh(boxes, DetectionEvidence(), SIZE)
    candidates = replace(candidates, log_odds=np.array([log_odds]))
    cost, _ = pair_costs(sure, candidates, ONLY, MeasurementModel(SIZE, 0.02))
    assert (cost < GATE).all() == (log_odds > 0)


def test_what_is_out_of_reach_costs_the_gate_and_all_else_what_its_edges_cost():
    # Unlikely detections at all distances, of the size of the vehicle and of a quarter of it.
    lefts = np.arange(-80.0, 330.0, 3.0)
    boxes = [(left, 100, width, 30 * width / 40) for left in lefts for width in (40, 20)]
    vehicles = together(track(1, 60), track(2, 200))
    candidates = weigh(Detections.make(boxes), DetectionEvidence(), SIZE)
    candidates = replace(candidates, log_odds=np.full(len(boxes), -1.0))
    columns = np.arange(len(boxes))
    costs, odds = pair_costs(vehicles, candidates, columns, MEASUREMENT)
    gaussians = vehicles.drives.gaussians
    spread = np.sqrt(gaussians.edge_variances + MEASUREMENT.deviations(gaussians.edges) ** 2)
    predicted = clipped(gaussians.edges, SIZE)
    for row in range(2):
        every = edge_costs(predicted[[row]], spread[[row]], candidates.edges)
        assert np.array_equal(np.minimum(costs[row], GATE), np.minimum(every, GATE))
        assert (every < GATE).sum() > 10
        assert np.isfinite(odds[row][every < GATE]).all()


def test_the_log_odds_of_a_pair_fall_with_its_distance_and_with_false_alarms_there():
    evidence, vehicle = DetectionEvidence(), track(1, 100.0)

    def odds(left):
        candidates = weigh(Detections.make([(left, 100, 40, 30)], [0.8]), evidence, SIZE)
        return float(pair_costs(vehicle, candidates, ONLY, MEASUREMENT)[1][0, 0])

    before = odds(100)
    assert before > 2
    assert odds(115) < 0
    sample = Sample(1.0, int(places_of(vehicle.edges, SIZE)[0]))
    for _ in range(30):
        evidence.begin_image()
        evidence.learn([sample], False)
    assert odds(100) < before - 2


def test_a_detection_where_a_track_is_predicted_is_rather_its_own_than_a_false_alarm():
    evidence = Experience().detections
    one = driven(track(1, 100.0), -1000.0, step_of(SIZE))
    both, here_only = [(103, 100, 40, 30), (280, 20, 9, 9)], (103, 100, 40, 30)
    here, aside = birth_odds(one, candidates_of(evidence, *both), np.arange(2), MEASUREMENT)[0]
    assert here > 2
    assert aside < -10
    sample = candidates_of(evidence, here_only).samples(np.array([0]))
    for _ in range(30):  # of a place where false alarms are common, less so
        evidence.begin_image()
        evidence.learn(sample, False)
    assert (
        birth_odds(one, candidates_of(evidence, here_only), np.array([0]), MEASUREMENT)[0, 0]
        < here - 2
    )
