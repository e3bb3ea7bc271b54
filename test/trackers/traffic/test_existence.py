# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that tracks are vehicles."""

from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import changed, step_of, together, track

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.association import birth_odds
from vehicle_pf_tracker.trackers.traffic.candidates import weighed
from vehicle_pf_tracker.trackers.traffic.detection_rate import DetectionRate
from vehicle_pf_tracker.trackers.traffic.ending import end
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode
from vehicle_pf_tracker.trackers.traffic.existence import (
    believed,
    doubt,
    drives,
    fits_of_known,
)
from vehicle_pf_tracker.trackers.traffic.prediction import driven
from vehicle_pf_tracker.trackers.traffic.state import Experience, State
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

SIZE = (320, 240)
SCORE = 1.0
"""Score of a detector that claims nothing."""
STEP = step_of(SIZE)
ONLY = np.array([0])


def seen(evidence, *boxes, are_shapes=False):
    """Detections of one frame, as the tracker has them."""
    evidence.look(are_shapes=are_shapes)
    return weighed(Detections.make(boxes, np.full(len(boxes), SCORE)), evidence, SIZE)


def ended_unconfirmed(places, *, are_shapes=False):
    """Return the log odds of a detection after ten tracks that were detected at these places."""
    experience = Experience()
    evidence = experience.detections
    for _ in range(10):
        one = track(1, *places[0])
        for frame, place in enumerate(places):
            one = driven(one, -1000.0, step_of(SIZE, elapsed=1.0 if frame else 0.0))
            candidates = seen(evidence, (*place, 40, 30), are_shapes=are_shapes)
            gaussians = one.drives.gaussians.measured(candidates.edges, np.ones((1, 4)))
            one = replace(one, drives=replace(one.drives, gaussians=gaussians))
            one, proven = believed(one, candidates, ONLY, np.zeros(1), experience, STEP)
            assert not proven
        state = end(State(changed(one, passed=100), experience), STEP)
        assert len(state.tracks) == 0
    return float(seen(evidence, (200, 180, 40, 30)).log_odds[0])


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


def reported_from(*, are_shapes, rate=30.0, shake=0.0, beside=()):
    """Number of images in which a drive of a tenth of its width per image is not reported.

    Another box drives with it, of the offset and size `beside`.
    """
    tracker = MultiVehicleTracker()
    tracker.frame_period = 1 / rate
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    for index in range(30):
        left = 20 + 4 * index + shake * (-1) ** index
        boxes = [(left, 100, 40, 30)]
        if beside:
            boxes.append((left + beside[0], 100, *beside[1:]))
        detections = replace(Detections.make(boxes), are_shapes=are_shapes)
        estimates = tracker.step(frame, detections)
        if any(one.identity and one.box.width > 30 for one in estimates):
            return index
    return 30


@pytest.mark.parametrize("rate", [30.0, 10.0])
def test_a_shape_is_a_vehicle_by_its_way_and_not_by_time(rate):
    assert reported_from(are_shapes=True, rate=rate) == 5


@pytest.mark.parametrize(
    ("are_shapes", "beside", "images"),
    [
        (True, (50, 40, 30), 15),  # half a second
        (True, (65, 40, 30), 5),  # out of reach
        (True, (50, 14, 14), 5),  # a speck
        (False, (50, 40, 30), 5),
    ],
)
def test_a_shape_with_another_one_beside_it_may_be_a_piece_for_half_a_second(
    are_shapes, beside, images
):
    assert reported_from(are_shapes=are_shapes, beside=beside) == images


@pytest.mark.parametrize("edge", range(4))
def test_a_shape_of_which_one_edge_moves_is_no_vehicle(edge):
    tracker = MultiVehicleTracker()
    frame = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    numbers = set()
    for index in range(140):
        # Vehicles as full as it teach that such shapes are vehicles.
        boxes = [(20 + 4 * (index % 35), 140, 40, 30)]
        edges = np.array([80.0, 60, 120, 100])
        if index >= 70:  # half of it is learnt by and by, as a clock's digit
            edges[edge] += (1 if edge < 2 else -1) * 2 * ((index - 70) // 7)
            boxes.append((*edges[:2], *(edges[2:] - edges[:2])))
        detections = replace(Detections.make(boxes, [0.9] * len(boxes)), are_shapes=True)
        estimates = tracker.step(frame, detections)
        numbers |= {one.identity for one in estimates if one.box.y < 110}
    assert numbers == {0}


def test_a_shape_that_shakes_as_it_drives_has_to_drive_farther():
    steady, shaking, boxed = (
        reported_from(are_shapes=True),
        reported_from(are_shapes=True, shake=4.0),
        reported_from(are_shapes=False, shake=4.0),
    )
    assert steady < boxed < shaking < 15


@pytest.mark.parametrize(
    ("way", "against", "is_told"),
    [(0.8, 0.0, True), (0.8, 5.0, False), (1.2, 5.0, True)],
)
def test_scores_are_ignored_only_of_what_drove_its_own_width(way, against, is_told):
    one = track(1, 100.0, doubt=against)
    ways = one.beliefs.ways
    for share in np.linspace(0, way, 60):
        edges = np.array([[100 + 40 * share, 100, 140 + 40 * share, 130]])
        ways = ways.older(1.0).added(edges)
    assert ways.evidence()[0] > 50
    gaussians = one.drives.gaussians.resized(edges)
    one = replace(one, drives=replace(one.drives, gaussians=gaussians))
    one = replace(one, beliefs=replace(one.beliefs, ways=ways))
    assert drives(one, STEP)[0] == is_told


def test_a_detection_where_a_track_is_predicted_is_rather_its_own_than_a_false_alarm():
    evidence = Experience().detections
    one = driven(track(1, 100.0), -1000.0, STEP)
    both, here_only = [(103, 100, 40, 30), (280, 20, 9, 9)], (103, 100, 40, 30)
    here, aside = birth_odds(one, seen(evidence, *both), np.arange(2), SIZE, 0.05)[0]
    assert here > 2
    assert aside < -10
    sample = seen(evidence, here_only).samples(ONLY)
    for _ in range(30):  # of a place where false alarms are common, less so
        evidence.look()
        evidence.learn(sample, False)
    assert birth_odds(one, seen(evidence, here_only), ONLY, SIZE, 0.05)[0, 0] < here - 2


def test_a_detector_that_finds_one_vehicle_in_three_is_known_to():
    experience = Experience()
    one, other = track(1, 100.0, confirmed=True, has_driven=True), track(2, 200.0, confirmed=True)
    for frame in range(300):
        missed = changed(one, undetected=float(frame % 3 > 0))
        doubt(State(together(missed, other), experience), STEP)
    assert experience.rate.share == pytest.approx(1 / 3, abs=0.05)


@pytest.mark.parametrize("found", [True, False])
def test_a_detector_that_became_worse_or_better_is_known_to_after_minutes(found):
    rate = DetectionRate()
    asked = np.ones(5, np.bool_)
    for _ in range(4000):
        rate.learn(asked, np.full(5, found))
    for _ in range(1000):
        shares = rate.learn(asked, np.full(5, not found))
    assert abs(rate.share - found) > 0.8
    assert 0 < shares[-1] < 1


@pytest.mark.parametrize(("rate", "images"), [(30.0, 10), (24.0, 10), (3.0, 6)])
def test_a_shape_that_shakes_is_asked_for_a_straighter_way_where_images_are_dense(rate, images):
    # Leaves swing straight in dense images, and are elsewhere in each of rare ones.
    assert reported_from(are_shapes=True, rate=rate, shake=4.0) == images


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
    ("rate", "every", "price"),
    [
        (30.0, 1, 0.3),
        (24.0, 1, 0.3),
        (12.0, 1, 0.6),
        (30.0, 3, 0.72),
        # A detector of which nothing is known finds one in two.
        (3.0, 1, -np.log(0.5)),
    ],
)
def test_a_miss_counts_by_the_time_that_it_stands_for_until_it_is_independent(rate, every, price):
    one = track(1, 100.0, confirmed=True, log_odds=5.0, undetected=every * 2.0, passed=1)
    step = step_of(SIZE, period=1 / rate)
    state = doubt(State(one, Experience()), step)
    lost = 5.0 - float(state.tracks.beliefs.log_odds[0])
    assert lost == pytest.approx(min(price, -np.log(0.5)), rel=0.01)


@pytest.mark.parametrize(("rate", "taken"), [(30.0, 0.5), (24.0, 0.5), (12.0, 1.0), (2.0, 3.0)])
def test_a_score_counts_against_a_track_by_the_time_that_it_stands_for(rate, taken):
    experience = Experience()
    step = step_of(SIZE, period=1 / rate)
    candidates = replace(seen(experience.detections, (100, 100, 40, 30)), gains=np.array([-5.0]))
    one, _ = believed(track(1, 100.0), candidates, ONLY, np.zeros(1), experience, step)
    assert one.beliefs.log_odds[0] == pytest.approx(-taken)
    assert one.beliefs.doubt[0] == pytest.approx(taken)


def missed(undetected, *, seen=()):
    """Evidence that confirmed vehicles in sight lose in a frame, undetected for so long."""
    tracks = together(
        *(
            track(
                identity,
                60.0 * identity,
                confirmed=True,
                log_odds=5.0,
                undetected=0.0 if identity in seen else periods,
            )
            for identity, periods in enumerate(undetected, start=1)
        )
    )
    state = doubt(State(tracks, Experience()), STEP)
    return (5.0 - state.tracks.beliefs.log_odds).tolist()


def test_a_vehicle_that_alone_is_missed_is_doubted():
    assert missed([3.0])[0] > 0
    lost = missed([3.0, 3.0], seen=(2,))
    assert lost[0] > 0
    assert lost[1] == 0


def test_a_detector_that_misses_all_vehicles_at_once_has_failed():
    assert missed([3.0, 3.0]) == [0, 0]


def test_vehicles_that_were_missed_one_after_the_other_do_not_excuse_each_other():
    assert min(missed([3.0, 5.0])) > 0


def test_what_pixels_hold_on_empty_road_at_the_border_is_soon_lost():
    rng = np.random.default_rng(0)
    road = rng.integers(0, 256, (SIZE[1], SIZE[0], 3)).astype(np.uint8)
    paint = rng.integers(0, 256, (40, 60, 3)).astype(np.uint8)
    tracker = MultiVehicleTracker()
    modes = []
    for index in range(140):
        frame = road.copy()
        # It leaves over the left border, ever slower, until most of it is outside.
        left = 140 * 0.9**index - 36
        boxes = [(max(left, 0), 100, 60 + min(left, 0), 40)]
        if index < 50:
            hidden = max(-round(left), 0)
            frame[100:140, hidden + round(left) : round(left) + 60] = paint[:, hidden:]
        detections = Detections.make(boxes if index < 50 else np.empty((0, 4)))
        modes.append([one.mode for one in tracker.step(frame, detections) if one.identity])
    assert modes[49] == [TrackMode.TRACKING]
    assert TrackMode.TRACKING not in modes[90]


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
    experience.detections.look(are_shapes=are_shapes)
    facts = {"confirmed": True, "has_driven": has_driven, "unseen": unseen, "undetected": 100.0}
    state = end(State(track(1, 100.0, **facts, log_odds=-20.0), experience), STEP)
    assert bool(len(state.tracks)) is is_known
    if is_known:
        assert state.tracks.absences.lost[0]


def test_vehicles_that_no_detector_sees_for_long_are_doubted_all():
    assert min(missed([200.0, 200.0])) > 0


@pytest.mark.parametrize(("log_odds", "is_lost"), [(0.1, False), (-0.1, True)])
def test_a_hidden_vehicle_is_lost_once_it_is_rather_not_there(log_odds, is_lost):
    facts = {"confirmed": True, "has_driven": True, "unseen": 30.0, "undetected": 30.0}
    state = State(track(1, 100.0, **facts, passed=30, log_odds=log_odds), Experience())
    assert end(state, STEP).tracks.absences.lost.tolist() == [is_lost]


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
    candidates = seen(Experience().detections, (left, 100, 40, 30))
    candidates = replace(candidates, log_odds=np.array([log_odds]), are_shapes=are_shapes)
    fits = fits_of_known(one, candidates, ONLY, np.array([fit]))
    one, _ = believed(one, candidates, ONLY, fits, experience or Experience(), STEP)
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
    evidence.look()
    by_score = evidence.by_score(np.array([SCORE]), np.array([0.5]))
    told = evidence.log_odds(by_score, np.array([0]))
    assert (told[0] > 0) == teaches
