# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Choice of the edges of a detection that are measured."""

import numpy as np
import pytest
from measured_vehicle import BOX, SIZE, Vehicle
from traffic_samples import changed, step_of, together, track_of

from vehicle_pf_tracker.core.overlaps import overlaps
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.correction import Comparison, correct, which_edges
from vehicle_pf_tracker.trackers.traffic.edge_observation import Edge
from vehicle_pf_tracker.trackers.traffic.first_state import first_gaussians
from vehicle_pf_tracker.trackers.traffic.prediction import driven
from vehicle_pf_tracker.trackers.traffic.report import estimates_of
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Motion

ROAD = Motion(0.002, 0.5, 768.0)
MEASUREMENT = MeasurementModel(SIZE, 0.05)
PART = BOX - (0, 0, 0, 12)


def driven_on(tracks, matches):
    """Predict tracks that were detected so often by an image."""
    gaussians = tracks.drives.gaussians.driven(1.0, ROAD)
    return changed(
        tracks,
        mean=gaussians.mean,
        covariance=gaussians.covariance,
        edges=gaussians.edges,
        matches=matches,
    )


@pytest.fixture
def vehicle():
    return Vehicle()


def test_a_whole_detection_measures_every_edge(vehicle):
    assert vehicle.see(BOX + 1)
    assert (vehicle.edges > BOX).all()


def test_a_covered_edge_does_not_brake_the_vehicle(vehicle):
    assert not vehicle.see(PART)
    assert vehicle.edges[Edge.BOTTOM] == pytest.approx(130, abs=0.3)
    assert vehicle.tracks.drives.extents.partial == 1


def test_a_verdict_is_given_before_anything_changes(vehicle):
    compared = Comparison.of(vehicle.tracks.drives, PART[None], MEASUREMENT)
    given = vehicle.tracks, compared
    verdict = which_edges(*given)
    assert verdict.covered.tolist() == [[False, False, False, True]]
    assert verdict.left_out.tolist() == verdict.covered.tolist()
    assert not verdict.whole.any()
    assert (vehicle.edges == BOX).all()
    assert (which_edges(*given).left_out == verdict.left_out).all()


def test_a_box_is_reported_a_quarter_of_the_way_to_its_detection(vehicle):
    vehicle.see(BOX + 1)
    (shown,) = estimates_of(vehicle.tracks)
    nearer = vehicle.edges + (BOX + 1 - vehicle.edges) / 4
    assert shown.box.corners[0] == pytest.approx(nearer[:2])
    vehicle.see(PART)  # of the covered edge nothing is known
    low = estimates_of(vehicle.tracks)[0].box.corners[2][1]
    assert low == pytest.approx(vehicle.edges[Edge.BOTTOM])
    later = driven(vehicle.tracks, -1e4, step_of())
    assert estimates_of(later)[0].box.corners[0] == pytest.approx(later.edges[0, :2])


def test_a_vehicle_that_brakes_is_followed(vehicle):
    # Both edges go the same way: it is not covered.
    assert vehicle.see(BOX - (0, 6, 0, 6))
    assert vehicle.edges[Edge.BOTTOM] < 129.8


def test_a_drive_that_detections_contradict_is_left(vehicle):
    # Two px farther in every frame, of a vehicle that was sure to stand.
    for frame in range(1, 21):
        vehicle.see(BOX + 2 * frame)
    assert vehicle.edges == pytest.approx(BOX + 40, abs=4)


def test_a_box_that_another_vehicle_widens_is_no_drive(vehicle):
    wider = BOX.copy()
    wider[Edge.RIGHT] += 15
    for _ in range(10):
        vehicle.see(wider)
    assert vehicle.tracks.drives.gaussians.edge_variances[0, Edge.LEFT] < 0.3


def test_an_edge_cut_by_the_border_is_not_measured():
    below = Vehicle(np.array([100.0, 215, 140, 250]))
    below.see(np.array([100.0, 215, 140, 240]))
    assert below.edges[Edge.BOTTOM] == pytest.approx(250, abs=0.2)


@pytest.mark.parametrize("side", [Edge.LEFT, Edge.RIGHT])
def test_two_vehicles_that_come_in_side_by_side_are_as_long_as_the_image_shows(side):
    # 120 px long, taken for less until their ends have come in; 4 px in each frame.
    length = 120
    fronts = np.arange(30, 180, 4.0)
    far = np.array([(max(front - length, 0.0), 100, front, 140) for front in fronts])
    if side is Edge.RIGHT:
        far[:, [Edge.LEFT, Edge.RIGHT]] = SIZE[0] - far[:, [Edge.RIGHT, Edge.LEFT]]
    both = np.stack([far, far + np.array([0, 15, 0, 15])], axis=1)
    first = first_gaussians(both[0], MEASUREMENT, np.full(2, -1e4), ROAD)
    rows = (track_of(first.take(np.array([row])), row + 1, confirmed=True) for row in range(2))
    tracks = together(*rows)
    for number, boxes in enumerate(both[1:], start=1):
        tracks = driven_on(tracks, number)
        # They stay as unsure of the end as it takes to be given the next box.
        predicted = tracks.drives.gaussians
        spread = MEASUREMENT.deviations(predicted.edges)[:, side]
        reach = np.sqrt(predicted.edge_variances[:, side] + spread**2)
        assert (np.abs(predicted.edges[:, side] - boxes[:, side]) < 4 * reach).all()
        tracks, _ = correct(tracks, boxes, MEASUREMENT)
    assert tracks.edges == pytest.approx(both[-1], abs=6)


def test_what_was_shown_of_a_vehicle_grows_with_it(vehicle):
    twice = np.array([80.0, 80, 160, 140])
    resized = vehicle.tracks.drives.gaussians.resized(twice[None])
    vehicle.tracks = changed(vehicle.tracks, mean=resized.mean, edges=resized.edges)
    # By this noise no edge jumps by a fifth of the height.
    assert not vehicle.see(twice - (0, 0, 0, 12), noise=0.1)


def test_an_edge_stays_covered_for_a_second_and_not_for_ever(vehicle):
    for _ in range(30):
        vehicle.see(PART)
    assert vehicle.edges[Edge.BOTTOM] == pytest.approx(130, abs=0.3)
    for _ in range(170):
        vehicle.see(PART)
    assert vehicle.edges[Edge.BOTTOM] < 125


def test_a_vehicle_that_drives_below_a_bridge_keeps_size_and_speed():
    # From the 15th image on its lower edge stays at the deck, while the upper one goes on.
    boxes = [BOX + np.tile((0.0, 1.5 * frame), 2) for frame in range(32)]
    horizon = np.array([-1e4])
    tracks = track_of(first_gaussians(boxes[0][None], MEASUREMENT, horizon, ROAD), confirmed=True)
    for number, box in enumerate(boxes[1:], start=1):
        tracks = driven_on(tracks, number)
        seen = np.minimum(box, (np.inf, np.inf, np.inf, boxes[15][Edge.BOTTOM]))
        tracks, _ = correct(tracks, seen[None], MEASUREMENT)
    assert tracks.edges[0] == pytest.approx(boxes[-1], abs=1)


@pytest.mark.parametrize("rate", [0.94, 0.97])
def test_a_vehicle_that_drives_away_fast_before_a_wrong_horizon_is_followed(rate):
    sides = 100 * rate ** np.arange(25)
    # By the horizon, far above, it would shrink by a ninth of this.
    boxes = np.array([(300 - a / 2, 250 - 0.3 * a, 300 + a / 2, 250 + 0.5 * a) for a in sides])
    measurement, horizon = MeasurementModel((640, 640), 0.05), np.array([-72.0])
    tracks = track_of(first_gaussians(boxes[:1], measurement, horizon, ROAD), confirmed=True)
    for number, box in enumerate(boxes[1:], start=1):
        tracks = driven_on(tracks, number)
        tracks, _ = correct(tracks, box[None], measurement)
        assert overlaps(tracks.edges[0], box) > 0.6
