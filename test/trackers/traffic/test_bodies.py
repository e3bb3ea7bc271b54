# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A lorry and its cab, which a network boxes both, are one vehicle; a car beside it is another."""

import numpy as np
import pytest
from traffic_samples import changed, together, track

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.bodies import (
    LONG_DRIVE,
    NO_COMPANIONS,
    SHORT_DRIVE,
    updated_companions,
)
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.identity import body_of, unify
from vehicle_pf_tracker.trackers.traffic.state import Experience, State
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

SIZE = (640, 240)
MEASUREMENT = MeasurementModel(SIZE, 0.05)
GROUND = np.random.default_rng(0).integers(90, 130, (240, 640, 3)).astype(np.uint8)
LORRY, CAB = np.array([100.0, 60, 200, 140]), np.array([165.0, 75, 200, 140])


def pair_of(small=CAB, large=LORRY):
    """A confirmed vehicle in the small box, and a younger one in the large box."""
    return together(
        changed(track(1, 100.0, confirmed=True), detection=small),
        changed(track(2, 100.0, confirmed=True), detection=large),
    )


def together_for(images, *, step=(8.0, 0.0), slip=0.0, start=(0.0, 0.0), small=CAB):
    """What is known of both after so many images of a drive, on which the small one slips back."""
    companions, way = NO_COMPANIONS, np.tile(step, 2)
    for image in range(images):
        at = np.tile(start, 2) + image * way
        tracks = pair_of(small + at - image * slip * way, LORRY + at)
        companions = updated_companions(companions, tracks, MEASUREMENT)
    return companions


def test_a_part_that_keeps_its_place_on_a_drive_of_the_whole_is_one_body():
    # The root of 100 px x 80 px is 89 px: 4.5 images of 8 px are .4 of it, 11.2 are all of it.
    assert not together_for(5)[1, 2].is_one(SHORT_DRIVE)
    assert together_for(6)[1, 2].is_one(SHORT_DRIVE)
    assert not together_for(12)[1, 2].is_one(LONG_DRIVE)
    assert together_for(13)[1, 2].is_one(LONG_DRIVE)
    assert together_for(13)[1, 2].driven == pytest.approx(12 * 8 / np.sqrt(100 * 80))


def test_what_stands_in_the_other_box_may_be_a_second_vehicle():
    assert not together_for(100, step=(0.0, 0.0))[1, 2].is_one(SHORT_DRIVE)


@pytest.mark.parametrize(("slip", "is_one"), [(0.1, True), (0.4, False)])
def test_another_speed_tells_two_vehicles_apart(slip, is_one):
    assert together_for(14, slip=slip)[1, 2].is_one(SHORT_DRIVE) is is_one


def test_a_car_in_the_next_lane_sticks_out_of_the_lorry():
    # A third of it is below: .67 of it is inside, however steady.
    lower = np.array([140.0, 120, 180, 150])
    assert not together_for(14, small=lower)[1, 2].is_one(SHORT_DRIVE)


def test_boxes_apart_in_one_image_void_all_that_spoke_for_one():
    before = together_for(14)
    beside = pair_of(CAB + np.array([30.0, 0, 30, 0]), LORRY)  # .14 of it is inside
    assert not updated_companions(before, beside, MEASUREMENT)


def test_images_in_which_the_border_cuts_the_whole_do_not_count():
    assert not together_for(14, start=(-100.0, 0.0), step=(0.0, 1.0))


def test_pairs_of_tracks_that_ended_are_dropped():
    alone = pair_of().take(np.array([1]))
    assert not updated_companions(together_for(14), alone, MEASUREMENT)


def test_the_elder_number_stays_with_the_box_of_all_of_it():
    tracks = pair_of()
    both = State(tracks, Experience(), companions=together_for(14), last_identity=2)
    assert body_of(both, 1) == 0
    assert body_of(both, 0) is None
    (one,) = unify(both).tracks.names.identity.tolist()
    assert one == 1
    merged = unify(both).tracks
    assert merged.names.joined.tolist() == [2]
    assert merged.edges == pytest.approx(tracks.edges[1:])


def test_a_vehicle_given_by_hand_is_not_merged():
    both = State(pair_of(), Experience(), companions=together_for(14))
    assert len(unify(both).tracks) == 1
    by_hand = both._replace(tracks=changed(both.tracks, by_hand=True))
    assert len(unify(by_hand).tracks) == 2


def numbers_on(boxes_of, *, images, seed):
    """Numbers given on a drive, with boxes that are noisy, missed now and then, and cut."""
    tracker, rng = MultiVehicleTracker(), np.random.default_rng(seed)
    for image in range(images):
        found = [
            edges + 0.03 * np.tile(edges[2:] - edges[:2], 2) * rng.standard_normal(4)
            for edges in (np.clip(one, 0, 640) for one in boxes_of(image))
            if edges[2] - edges[0] > 8 and rng.uniform() < 0.8
        ]
        boxes = [(*edges[:2], *(edges[2:] - edges[:2])) for edges in found]
        tracker.step(GROUND, Detections.make(boxes, [0.6] * len(boxes)))
    return tracker.last_identity


def moved(edges, way):
    return edges + np.array([way, 0, way, 0])


@pytest.mark.parametrize("seed", range(3))
def test_a_lorry_boxed_as_a_whole_and_as_a_cab_has_one_number(seed):
    """From left to right through the image, so that the cab comes and leaves first."""

    def lorry(image):
        return [moved(LORRY, 8.0 * image - 200), moved(CAB, 8.0 * image - 200)]

    assert numbers_on(lorry, images=110, seed=seed) == 1


@pytest.mark.parametrize("seed", range(3))
def test_a_car_that_passes_a_lorry_has_its_own(seed):
    car = np.array([20.0, 100, 80, 150])

    def passing(image):
        return [moved(LORRY, 6.0 * image - 200), moved(car, 9.0 * image - 200)]

    assert numbers_on(passing, images=80, seed=seed) == 2
