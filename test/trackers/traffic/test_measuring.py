# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Choice of the edges of a detection that are measured."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.overlaps import overlaps
from vehicle_pf_tracker.trackers.traffic.detection_evidence import places_of
from vehicle_pf_tracker.trackers.traffic.measuring import first_state, measure, outgrown
from vehicle_pf_tracker.trackers.traffic.occlusion import Returns
from vehicle_pf_tracker.trackers.traffic.parameters import DetectionParameters
from vehicle_pf_tracker.trackers.traffic.track import FEW, RATE, Track, predict
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Drive, Edge, VehicleState

SIZE = (320, 240)
DRIVE, ROAD = Drive(0.001, 0.5, 400.0), Drive(0.002, 0.5, 768.0)
BOX = np.array([100.0, 100, 140, 130])
PART = BOX - (0, 0, 0, 12)
(PLACE,) = places_of(BOX[None], SIZE)


@pytest.fixture
def track():
    """A vehicle whose box has been measured often."""
    one = Track(1, VehicleState(BOX, np.full(4, 0.3), -1e4, DRIVE), matches=20)
    one.shown = np.ones(2)
    return one


def measured(track, detection, *others, uncoverings=None, settings=None):
    edges = np.array([detection], float)
    every = np.vstack([edges, *others])
    settings = settings or DetectionParameters()
    (whole,) = measure([track], edges, settings, SIZE, every, uncoverings or Returns())
    return whole


def test_a_whole_detection_measures_every_edge(track):
    assert measured(track, BOX + 1)
    assert (track.state.edges > BOX).all()


def test_a_covered_edge_does_not_brake_the_vehicle(track):
    assert not measured(track, PART)
    assert track.state.edges[Edge.BOTTOM] == pytest.approx(130, abs=0.3)
    assert track.partial == 1


def test_a_box_is_reported_a_quarter_of_the_way_to_its_detection(track):
    measured(track, BOX + 1)
    shown, edges = track.estimate().box, track.state.edges
    assert shown.corners[0] == pytest.approx(edges[:2] + RATE * (BOX + 1 - edges)[:2])
    measured(track, PART)  # of the covered edge nothing is known
    low = track.estimate().box.corners[2][1]
    assert low == pytest.approx(track.state.edges[Edge.BOTTOM])
    predict([track], -1e4, 1.0, DRIVE)
    assert track.estimate().box == track.state.box


def test_a_vehicle_that_brakes_is_followed(track):
    # Both edges go the same way: it is not covered.
    assert measured(track, BOX - (0, 6, 0, 6))
    assert track.state.edges[Edge.BOTTOM] < 129.8


def test_a_drive_that_detections_contradict_is_left(track):
    # Two px farther in every frame, of a vehicle that was sure to stand.
    for frame in range(1, 21):
        measured(track, BOX + 2 * frame)
    assert track.state.edges == pytest.approx(BOX + 40, abs=4)


def test_a_box_that_another_vehicle_widens_is_no_drive(track):
    wider = BOX.copy()
    wider[Edge.RIGHT] += 15
    for _ in range(10):
        measured(track, wider)
    assert track.state.edge_covariance[Edge.LEFT, Edge.LEFT] < 0.3


def test_an_edge_cut_by_the_border_is_not_measured():
    below = np.array([100.0, 215, 140, 250])
    one = Track(1, VehicleState(below, np.full(4, 0.3), -1e4, DRIVE), matches=20)
    measured(one, np.array([100.0, 215, 140, 240]))
    assert one.state.edges[Edge.BOTTOM] == pytest.approx(250, abs=0.2)


def test_what_was_shown_of_a_vehicle_grows_with_it(track):
    settings = DetectionParameters(edge_noise=0.1)  # no edge jumps by a fifth of the height
    twice = np.array([80.0, 80, 160, 140])
    track.state.resize(twice)
    assert not measured(track, twice - (0, 0, 0, 12), settings=settings)


def test_no_edge_stays_covered_for_ever(track):
    for _ in range(200):
        measured(track, PART)
    assert track.state.edges[Edge.BOTTOM] < 125


@pytest.mark.parametrize("found", [True, False])
def test_where_parts_do_not_come_back_a_smaller_vehicle_is_believed_soon(track, found):
    uncoverings = Returns()
    uncoverings.learn(PLACE, found=found)
    for _ in range(FEW):
        measured(track, PART, uncoverings=uncoverings)
    assert track.state.edges[Edge.BOTTOM] == pytest.approx(130, abs=0.1)
    for _ in range(20):
        measured(track, PART, uncoverings=uncoverings)
    assert bool(track.state.edges[Edge.BOTTOM] > 129.9) is found


def test_where_parts_come_back_is_learnt(track):
    uncoverings = Returns()
    for box in [PART] * FEW + [BOX]:
        measured(track, box, uncoverings=uncoverings)
    assert uncoverings.share(PLACE) > 0.5
    for box in [PART] * (FEW - 1) + [BOX]:  # too few to tell
        measured(track, box, uncoverings=uncoverings)
    assert uncoverings.share(PLACE) == pytest.approx((1 + 2 * 2 / 3) / 3)
    for _ in range(100):
        measured(track, PART, uncoverings=uncoverings)
    assert uncoverings.share(PLACE) == pytest.approx(1 / 2)


def test_a_vehicle_cut_at_the_border_gets_the_usual_height():
    state = first_state(np.array([100.0, 0, 140, 8]), 0.05, -40.0, DRIVE, SIZE)
    assert state.box.height == pytest.approx(0.8 * 40)
    assert state.edges[Edge.BOTTOM] == 8


def test_a_thin_first_box_may_grow():
    thin = first_state(np.array([100.0, 100, 140, 110]), 0.05, -40.0, DRIVE, SIZE)
    whole = first_state(BOX, 0.05, -40.0, DRIVE, SIZE)
    assert thin.edge_covariance[1, 1] > 10 * whole.edge_covariance[1, 1]


@pytest.mark.parametrize(
    ("other", "is_several"),
    [
        ((118.0, 98, 142, 114), True),  # farther, where the detection lacks a part
        ((118.0, 112, 142, 136), False),  # nearer: it hides the part
        ((101.0, 115, 117, 129), False),  # inside: a part of the same vehicle
    ],
)
def test_a_box_that_was_several_vehicles_becomes_the_nearest_one(track, other, is_several):
    own = np.array([100.0, 114, 118, 130])
    for _ in range(FEW):
        measured(track, own, other)
    assert (track.state.edges == pytest.approx(own, abs=1)) is is_several


def test_a_part_without_another_detection_is_not_taken_for_several(track):
    own = np.array([100.0, 114, 118, 130])
    for _ in range(3):
        measured(track, own)
    assert track.state.edges[Edge.RIGHT] == pytest.approx(140, abs=1)


WHOLE = np.array([[90.0, 96, 150, 134]])


def missed(left=100.0, *, matches=6):
    """A confirmed vehicle that no detection was given to."""
    box = BOX + np.array([left - 100, 0, left - 100, 0])
    return Track(
        1, VehicleState(box, np.full(4, 0.3), -1e4, DRIVE), 1, matches=matches, undetected=1.0
    )


def test_boxes_of_the_whole_vehicle_replace_a_part_that_was_seen_first():
    track = missed()
    found = [outgrown([track], WHOLE) for _ in range(FEW)]
    assert found == [[]] * (FEW - 1) + [[track]]
    assert track.state.edges == pytest.approx(WHOLE[0])


def test_two_vehicles_in_one_box_stay_two():
    tracks = [missed(), missed(125.0)]
    assert not any(outgrown(tracks, WHOLE) for _ in range(20))


def test_a_vehicle_that_was_often_seen_alone_does_not_soon_become_a_box_of_two():
    track = missed(matches=40)
    assert not any(outgrown([track], WHOLE) for _ in range(15))


@pytest.mark.parametrize("rate", [0.94, 0.97])
def test_a_vehicle_that_drives_away_fast_before_a_wrong_horizon_is_followed(rate):
    sides = 100 * rate ** np.arange(25)
    # By the horizon, far above, it would shrink by a ninth of this.
    boxes = np.array([(300 - a / 2, 250 - 0.3 * a, 300 + a / 2, 250 + 0.5 * a) for a in sides])
    track = Track(1, first_state(boxes[0], 0.05, -72.0, ROAD, (640, 640)), 1, matches=1)
    for box in boxes[1:]:
        predict([track], -72.0, 1.0, ROAD)
        measure([track], box[None], DetectionParameters(), (640, 640), box[None], Returns())
        track.add_evidence(box, 0.0, 0.0)
        assert overlaps(track.state.edges, box) > 0.6
