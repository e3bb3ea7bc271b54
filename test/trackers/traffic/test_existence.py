# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that tracks are vehicles."""

from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import DRIVE, track

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.association import FrameDetections, birth_odds
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins
from vehicle_pf_tracker.trackers.traffic.detection_evidence import CERTAIN, DetectionEvidence
from vehicle_pf_tracker.trackers.traffic.existence import Existence
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.track import FEW, predict
from vehicle_pf_tracker.trackers.traffic.tracker import TrafficTracker

SIZE = (320, 240)
SCORE = 0.8


def found(evidence, *boxes):
    """Detections of one frame, as the tracker has them."""
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    detections = Detections.make(boxes, np.full(len(boxes), SCORE))
    evidence.look()
    return FrameDetections(detections, evidence, ColourBins(frame), SIZE)


def ended_unconfirmed(places):
    """Return the log odds of a detection after ten tracks that were detected at these places."""
    evidence = DetectionEvidence()
    existence = Existence(TrafficParameters(), evidence)
    for _ in range(10):
        one = track(1, *places[0])
        for frame, place in enumerate(places):
            predict([one], -1000.0, 1.0 if frame else 0.0, DRIVE)
            detections = found(evidence, (*place, 40, 30))
            one.state.measure(detections.edges[0], np.ones(4))
            assert not existence.detected(one, detections, 0, 0.0)
        one.undetected = 100.0
        assert existence.survivors([one], SIZE, 1 / 30) == []
    return float(found(evidence, (200, 180, 40, 30)).log_odds[0])


def test_what_flickered_in_one_place_speaks_against_its_scores():
    jitter = np.random.default_rng(4).normal(0, 3, (8, 2))
    assert ended_unconfirmed(100 + jitter) < -1


def test_what_drove_and_ended_unconfirmed_tells_nothing_about_its_scores():
    assert ended_unconfirmed([(20 + 4 * frame, 100) for frame in range(8)]) == pytest.approx(0)


def test_what_was_seen_a_few_times_speaks_against_its_scores():
    assert ended_unconfirmed([(20 + 4 * frame, 100) for frame in range(3)]) < -1


@pytest.mark.parametrize(
    ("are_shapes", "rate", "first", "last"),
    [(True, 30.0, 0.5, 0.6), (True, 10.0, 0.5, 0.8), (False, 30.0, 0.0, 0.3)],
)
def test_a_shape_that_drives_may_be_a_piece_of_a_vehicle_for_half_a_second(
    are_shapes, rate, first, last
):
    tracker = TrafficTracker()
    tracker.frame_period = 1 / rate
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    for index in range(30):
        box = (20 + 4 * index, 100, 40, 30)
        detections = replace(Detections.make([box]), are_shapes=are_shapes)
        if any(one.identity for one in tracker.step(frame, detections)):
            break
    assert first <= index / rate <= last


def test_a_detection_where_a_track_is_predicted_is_rather_its_own_than_a_false_alarm():
    evidence = DetectionEvidence()
    one = track(1, 100.0)
    predict([one], -1000.0, 1.0, DRIVE)
    here, aside = birth_odds(
        [one], found(evidence, (103, 100, 40, 30), (280, 20, 9, 9)), [0, 1], 0.05
    )[0]
    assert here > 2
    assert aside < -10
    sample = found(evidence, (103, 100, 40, 30)).samples[0]
    for _ in range(30):  # of a place where false alarms are common, less so
        evidence.look()
        evidence.learn(sample, False)
    assert birth_odds([one], found(evidence, (103, 100, 40, 30)), [0], 0.05)[0, 0] < here - 2


def test_a_detector_that_finds_one_vehicle_in_three_is_known_to():
    existence = Existence(TrafficParameters(), DetectionEvidence())
    one = track(1, 100.0, confirmed=True, has_driven=True)
    for frame in range(300):
        one.undetected, one.log_odds = float(frame % 3 > 0), 5.0
        existence.fade([one, track(2, 200.0, confirmed=True)], 1.0, SIZE)
    assert existence.detection_rate == pytest.approx(1 / 3, abs=0.05)


def missed(undetected, *, seen=()):
    """Evidence that confirmed vehicles in sight lose in a frame, undetected for so long."""
    tracks = [
        track(
            identity,
            60.0 * identity,
            confirmed=True,
            log_odds=5.0,
            undetected=0.0 if identity in seen else periods,
        )
        for identity, periods in enumerate(undetected, start=1)
    ]
    Existence(TrafficParameters(), DetectionEvidence()).fade(tracks, 1.0, SIZE)
    return [5.0 - one.log_odds for one in tracks]


def test_a_vehicle_that_alone_is_missed_is_doubted():
    assert missed([3.0])[0] > 0
    lost = missed([3.0, 3.0], seen=(2,))
    assert lost[0] > 0
    assert lost[1] == 0


def test_a_detector_that_misses_all_vehicles_at_once_has_failed():
    assert missed([3.0, 3.0]) == [0, 0]


def test_vehicles_that_no_detector_sees_for_long_are_doubted_all():
    assert min(missed([200.0, 200.0])) > 0


def vanish(existence, left, *, given=False):
    """Return a vehicle that the detector missed several times in plain sight."""
    facts = {"confirmed": True, "has_driven": True, "given": given}
    one = track(1, left, **facts, log_odds=CERTAIN, undetected=1.0)
    for _ in range(FEW):
        existence.fade([one], 1.0, SIZE)
        existence.survivors([one], SIZE, 1 / 30)
    return one


def end(existence, left):
    """Let a vehicle vanish and never come back."""
    one = vanish(existence, left)
    one.unseen = 1e3
    assert existence.survivors([one], SIZE, 1 / 30) == []


def come_back(existence, left):
    """Let a vehicle vanish and be found again."""
    existence.resume(vanish(existence, left), track(2, left))


def test_what_vanished_where_vehicles_come_back_is_occluded_and_elsewhere_lost():
    existence = Existence(TrafficParameters(), DetectionEvidence())
    assert not vanish(existence, 100.0).lost  # nothing is known
    for _ in range(3):
        come_back(existence, 20.0)
        end(existence, 200.0)
    assert not vanish(existence, 20.0).lost
    assert vanish(existence, 200.0).lost
    come_back(existence, 20.0)
    assert not vanish(existence, 120.0).lost  # most came back, wherever that was


def test_the_share_of_a_place_is_a_beta_binomial_estimate():
    existence = Existence(TrafficParameters(), DetectionEvidence())
    end(existence, 20.0)
    end(existence, 20.0)
    come_back(existence, 200.0)
    usual = (1 + 1) / (3 + 2)
    shares = [
        existence.reappearances.share(vanish(existence, left).vanished) for left in (20.0, 200.0)
    ]
    assert shares == pytest.approx([2 * usual / 4, (1 + 2 * usual) / 3])


@pytest.mark.parametrize("found", [True, False])
def test_what_becomes_of_a_vehicle_becomes_of_the_part_that_was_missing(found):
    existence = Existence(TrafficParameters(), DetectionEvidence())
    one = vanish(existence, 100.0)
    for _ in range(FEW):
        one.shorten((3, 5), is_short=True)
    if found:
        existence.resume(one, track(2, 100.0))
    else:
        one.unseen = 1e3
        existence.survivors([one], SIZE, 1 / 30)
    assert (existence.uncoverings.share((3, 5)) > 0.5) is found
    assert one.shortened is None


def test_a_place_is_learnt_anew():
    existence = Existence(TrafficParameters(), DetectionEvidence())
    for _ in range(500):
        come_back(existence, 100.0)
    for _ in range(40):
        end(existence, 100.0)
    assert vanish(existence, 100.0).lost


def test_one_that_was_given_by_hand_stays_and_teaches_nothing():
    existence = Existence(TrafficParameters(), DetectionEvidence())
    end(existence, 100.0)
    one = vanish(existence, 100.0, given=True)
    assert not one.lost
    assert one.vanished is None


def evidence_of(fit, *, drives=True):
    """Evidence that a detection which fits its confirmed vehicle so well adds by where it is."""
    existence, evidence = Existence(TrafficParameters(), DetectionEvidence()), DetectionEvidence()
    one = track(1, 100.0, confirmed=True, has_driven=True)
    for frame in range(20):
        left = 100.0 + 3 * frame * drives
        predict([one], -1000.0, 1.0, replace(DRIVE, acceleration=0.001))
        one.state.measure(np.array([left, 100, left + 40, 130]), np.full(4, 0.5))
    existence.detected(one, found(evidence, (left, 100, 40, 30)), 0, fit)
    return one.log_odds


def test_a_detection_of_a_vehicle_counts_by_how_much_better_it_fits_than_a_false_alarm():
    assert evidence_of(9.0) > evidence_of(0.5) > 0 > evidence_of(-0.2)


def test_where_a_vehicle_stands_any_false_alarm_there_would_fit():
    assert evidence_of(9.0, drives=False) == 0
