# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""End of tracks that are no vehicles, or have left."""

from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import candidates_of, changed, step_of, track

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.ending import end_tracks
from vehicle_pf_tracker.trackers.traffic.existence import add_evidence
from vehicle_pf_tracker.trackers.traffic.prediction import driven
from vehicle_pf_tracker.trackers.traffic.state import Experience, State
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

SIZE = (320, 240)
STEP = step_of(SIZE)
ONLY = np.array([0])

# Boxes are 40 px wide, and the image 320.


def ends(left, **facts):
    """Tell whether the track of a vehicle with its left edge there ends."""
    state = State(track(1, left, confirmed=True, **facts), Experience())
    return not len(end_tracks(state, step_of()).tracks)


@pytest.mark.parametrize(
    ("left", "undetected", "expected"),
    [
        (315.0, 1.0, False),  # an eighth of it is inside
        (318.0, 1.0, True),  # a twentieth
        (318.0, 0.0, False),
        (321.0, 0.0, True),
    ],
    ids=["partly inside", "hardly inside", "hardly inside, detected", "outside, detected"],
)
def test_a_vehicle_has_left_when_hardly_any_of_it_is_inside_unless_it_is_detected(
    left, undetected, expected
):
    assert ends(left, undetected=undetected) == expected


def ended_unconfirmed(places, *, are_shapes=False):
    """Return the log odds of a detection after ten tracks that were detected at these places."""
    experience = Experience()
    evidence = experience.detections
    for _ in range(10):
        one = track(1, *places[0])
        for frame, place in enumerate(places):
            one = driven(one, -1000.0, step_of(SIZE, elapsed=1.0 if frame else 0.0))
            candidates = candidates_of(evidence, (*place, 40, 30), are_shapes=are_shapes)
            gaussians = one.drives.gaussians.measured(candidates.edges, np.ones((1, 4)))
            one = replace(one, drives=replace(one.drives, gaussians=gaussians))
            one, proven = add_evidence(one, candidates, ONLY, np.zeros(1), experience, STEP)
            assert not proven
        state = end_tracks(State(changed(one, searched=100), experience), STEP)
        assert len(state.tracks) == 0
    return float(candidates_of(evidence, (200, 180, 40, 30)).log_odds[0])


def test_what_flickered_in_one_place_speaks_against_its_scores():
    jitter = np.random.default_rng(4).normal(0, 3, (8, 2))
    assert ended_unconfirmed(100 + jitter) < -1


def test_what_drove_and_ended_unconfirmed_tells_nothing_about_its_scores():
    assert ended_unconfirmed([(20 + 4 * frame, 100) for frame in range(8)]) == pytest.approx(0)


@pytest.mark.parametrize(("are_shapes", "teaches"), [(False, False), (True, True)])
def test_a_shape_that_ends_is_a_false_alarm_unless_it_is_as_straight_as_one_with_a_number(
    are_shapes, teaches
):
    # Straight enough for a box, not for a shape: the evidence is 14.
    places = [(20 + 4 * frame, 100 + (3 if frame % 2 else -3)) for frame in range(8)]
    odds = ended_unconfirmed(places, are_shapes=are_shapes)
    assert odds < -1 if teaches else odds == pytest.approx(0)


def test_what_was_seen_a_few_times_speaks_against_its_scores():
    assert ended_unconfirmed([(20 + 4 * frame, 100) for frame in range(3)]) < -1


@pytest.mark.parametrize("every", [1, 3])
def test_a_track_is_given_up_after_looks_that_miss_it_and_not_after_images(every):
    tracker = MultiVehicleTracker()
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    nothing = Detections.make(np.empty((0, 4)))
    tracker.step(frame, Detections.make([(100, 100, 40, 30)], [0.9]))
    looks = 0
    for index in range(1, 60):
        is_look = index % every == 0
        looks += is_look
        if not tracker.step(frame, nothing if is_look else None):
            break
    # At a rate of a half, eight misses are four detections.
    assert looks == 9


def test_a_track_that_no_detector_looks_for_is_forgotten_as_a_vehicle_is():
    tracker = MultiVehicleTracker()
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    tracker.step(frame, Detections.make([(100, 100, 40, 30)], [0.3]))
    images = [len(tracker.step(frame)) for _ in range(160)]
    assert sum(images) == 150


@pytest.mark.parametrize(
    ("unseen", "has_driven", "are_shapes", "is_known"),
    [
        (100.0, True, False, True),  # behind a bridge, say
        (200.0, True, False, False),  # for longer than a LOST vehicle is kept in mind
        (0.0, True, False, False),  # held by pixels where the detector sees none
        (100.0, False, False, False),
        (100.0, True, True, False),
    ],
)
def test_misses_refute_no_vehicle_that_has_driven_and_is_hidden(
    unseen, has_driven, are_shapes, is_known
):
    experience = Experience()
    experience.detections.begin_image(are_shapes=are_shapes)
    facts = {"confirmed": True, "has_driven": has_driven, "unseen": unseen, "undetected": 100.0}
    state = end_tracks(State(track(1, 100.0, **facts, log_odds=-20.0), experience), STEP)
    assert bool(len(state.tracks)) is is_known
    if is_known:
        assert state.tracks.absences.lost[0]


@pytest.mark.parametrize(("log_odds", "is_lost"), [(0.1, False), (-0.1, True)])
def test_a_hidden_vehicle_is_lost_once_it_is_rather_not_there(log_odds, is_lost):
    facts = {"confirmed": True, "has_driven": True, "unseen": 30.0, "undetected": 30.0}
    state = State(track(1, 100.0, **facts, searched=30, log_odds=log_odds), Experience())
    assert end_tracks(state, STEP).tracks.absences.lost.tolist() == [is_lost]
