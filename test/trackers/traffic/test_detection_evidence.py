# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence of detections, learnt from their outcomes."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.detection_evidence import (
    NO_CLAIM,
    DetectionEvidence,
    Sample,
    claims_of,
    places_of,
)

SIZE = (320, 240)
ROAD, TREE = np.array([100.0, 100, 140, 130]), np.array([10.0, 10, 20, 20])


def sample(edges, score):
    return Sample(score, int(places_of(edges[np.newaxis], SIZE)[0]))


def taught(transform=lambda score: score):
    evidence = DetectionEvidence()
    rng = np.random.default_rng(3)
    for score in rng.uniform(0.1, 0.9, 600).tolist():
        evidence.learn([sample(ROAD, transform(score))], bool(score > 0.5))
    return evidence


def odds(evidence, edges, *scores):
    evidence.begin_image()
    places = places_of(np.tile(edges, (len(scores), 1)), SIZE)
    by_score = evidence.by_score(np.array(scores), np.full(len(scores), NO_CLAIM))
    return evidence.log_odds(by_score, places)


def test_nothing_is_known_at_first():
    assert odds(DetectionEvidence(), ROAD, 0.1, 0.9).tolist() == [0, 0]


def test_before_anything_is_known_a_score_is_what_its_detector_says():
    scores = np.array([0.1, 0.5, 0.9])
    places = np.zeros(3, np.intp)
    nothing_known = DetectionEvidence()
    claimed = nothing_known.log_odds(nothing_known.by_score(scores, claims_of(scores)), places)
    assert claimed == pytest.approx([-np.log(9), 0, np.log(9)])
    evidence = taught(lambda score: 1 - score)
    evidence.begin_image()
    low, _, high = evidence.log_odds(evidence.by_score(scores, claims_of(scores)), places)
    assert low > 1.5 > -1.5 > high  # it is worth few detections


@pytest.mark.parametrize("scores", [(1.0, 1.0), (0.4, 7.0), (-0.2, 0.5), (0.0, 1.0)])
def test_scores_of_other_scales_and_none_claim_nothing(scores):
    assert (claims_of(np.array(scores)) == NO_CLAIM).all()


def test_scores_that_were_vehicles_speak_for_one():
    low, middle, high = odds(taught(), ROAD, 0.2, 0.5, 0.8)
    assert low < -2.5
    assert abs(middle) < 1
    assert high > 2.5


@pytest.mark.parametrize("transform", [np.square, lambda score: score / 2, np.log])
def test_only_the_order_of_scores_counts(transform):
    scores = [0.15, 0.45, 0.55, 0.88]
    changed = odds(taught(transform), ROAD, *(float(transform(score)) for score in scores))
    assert changed == pytest.approx(odds(taught(), ROAD, *scores))


def test_a_place_of_false_alarms_speaks_against_a_detection_and_never_for_one():
    evidence = taught()
    before = odds(evidence, ROAD, 0.8)
    for _ in range(50):
        evidence.learn([sample(TREE, 0.8)], False)
    for _ in range(200):
        evidence.learn([sample(ROAD, 0.8)], True)
    assert odds(evidence, TREE, 0.8) < odds(evidence, ROAD, 0.8) - 2
    assert odds(evidence, ROAD, 0.8) < before + 2


def test_no_detections_have_no_odds():
    assert len(odds(taught(), ROAD)) == 0


def test_places_with_false_alarms_are_counted_and_forgotten():
    evidence = DetectionEvidence()
    evidence.learn([sample(TREE, 0.5)], False)
    evidence.learn([sample(ROAD, 0.5)], True)
    assert evidence.cluttered == 1
    for _ in range(20_000):
        evidence.begin_image()
    assert evidence.cluttered == 0
