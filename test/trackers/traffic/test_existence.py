# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that tracks are vehicles, by their detections."""

from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import candidates_of, step_of, track

from vehicle_pf_tracker.trackers.traffic.existence import add_evidence, position_evidence
from vehicle_pf_tracker.trackers.traffic.state import Experience

SIZE = (320, 240)
SCORE = 1.0
"""Score of a detector that claims nothing."""
STEP = step_of(SIZE)
ONLY = np.array([0])


def evidence_of(fit, *, drives=True, log_odds=0.0, are_shapes=False, experience=None):
    """Evidence that a detection which fits its confirmed vehicle so well adds by where it is."""
    one = track(1, 100.0, confirmed=True, has_driven=True)
    smooth = replace(STEP.motion, acceleration=0.001)
    gaussians = one.drives.gaussians
    for frame in range(20):
        left = 100.0 + 3 * frame * drives
        box = np.array([[left, 100, left + 40, 130]])
        gaussians = gaussians.driven(1.0, smooth).measured(box, np.full((1, 4), 0.5))
    one = replace(one, drives=replace(one.drives, gaussians=gaussians))
    candidates = candidates_of(Experience().detections, (left, 100, 40, 30))
    candidates = replace(candidates, log_odds=np.array([log_odds]), are_shapes=are_shapes)
    fits = position_evidence(one, candidates, ONLY, np.array([fit]))
    one, _ = add_evidence(one, candidates, ONLY, fits, experience or Experience(), STEP)
    return float(one.beliefs.log_odds[0])


def test_a_detection_of_a_vehicle_counts_by_how_much_better_it_fits_than_a_false_alarm():
    assert evidence_of(9.0) > evidence_of(0.5) > 0 > evidence_of(-0.2)


def test_where_a_vehicle_stands_any_false_alarm_there_would_fit():
    assert evidence_of(9.0, drives=False) == 0


def test_no_fit_tells_where_the_detector_says_the_same_with_nothing_there():
    assert evidence_of(9.0, log_odds=-4.9) == pytest.approx(3.0 - 0.5)
    assert evidence_of(9.0, log_odds=-5.1) == pytest.approx(-0.5)
    assert evidence_of(-2.0, log_odds=-5.1) == pytest.approx(-2.5)
    # The score of a shape says how full it is.
    assert evidence_of(9.0, log_odds=-5.1, are_shapes=True) == pytest.approx(3.0 - 0.5)


@pytest.mark.parametrize(("log_odds", "teaches"), [(-2.9, True), (-3.1, False)])
def test_a_vehicle_does_not_teach_that_what_the_detector_says_anyway_is_one(log_odds, teaches):
    experience = Experience()
    evidence_of(9.0, log_odds=log_odds, experience=experience)
    evidence = experience.detections
    evidence.begin_image()
    by_score = evidence.by_score(np.array([SCORE]), np.array([0.5]))
    told = evidence.log_odds(by_score, np.array([0]))
    assert (told[0] > 0) == teaches


@pytest.mark.parametrize(("rate", "taken"), [(30.0, 0.5), (24.0, 0.5), (12.0, 1.0), (2.0, 3.0)])
def test_a_score_counts_against_a_track_by_the_time_that_it_stands_for(rate, taken):
    experience = Experience()
    step = step_of(SIZE, period=1 / rate)
    candidates = replace(
        candidates_of(experience.detections, (100, 100, 40, 30)), gains=np.array([-5.0])
    )
    one, _ = add_evidence(track(1, 100.0), candidates, ONLY, np.zeros(1), experience, step)
    assert one.beliefs.log_odds[0] == pytest.approx(-taken)
    assert one.beliefs.doubt[0] == pytest.approx(taken)
