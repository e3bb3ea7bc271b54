# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracker of many vehicles, from boxes with known truth."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import BORDER_OCCLUDER, SCENE_OCCLUDER, TrackMode
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Gaussians

GROUND = np.random.default_rng(0).integers(90, 130, (240, 320, 3)).astype(np.uint8)
PAINT = np.random.default_rng(1).integers(0, 255, (80, 80, 3)).astype(np.uint8)
FLAT = TrafficParameters()
FLAT = replace(FLAT, motion=replace(FLAT.motion, horizon=-50.0))


def scene(*boxes):
    frame = GROUND.copy()
    for index, (x, y, w, h) in enumerate(boxes):
        frame[y : y + h, x : x + w] = PAINT[10 * index : 10 * index + h, :w]
    return frame


def drive(tracker, frames, seen=lambda index: True, right=lambda index: 20 + 4 * index):
    """Show a vehicle that drives to the right, detected where `seen` says so."""
    every = []
    for index in range(frames):
        box = (right(index), 100, 40, 30)
        detections = Detections.make([box] if seen(index) else np.empty((0, 4)))
        every.append(tracker.step(scene(box), detections))
    return every


def test_a_vehicle_is_tentative_without_a_number_then_followed_under_one():
    every = drive(MultiVehicleTracker(FLAT), 40)
    every = [estimates for estimates in every if estimates]
    for (one,) in every:
        assert one.identity == (one.mode is not TrackMode.TENTATIVE)
    modes = [estimates[0].mode for estimates in every]
    assert modes[0] is TrackMode.TENTATIVE
    assert modes[-1] is TrackMode.TRACKING
    assert modes == sorted(modes, key=lambda mode: mode is TrackMode.TRACKING)
    assert every[-1][0].box.centre == pytest.approx((20 + 4 * 39 + 20, 115), abs=1)
    assert every[-1][0].velocity == pytest.approx((4, 0), abs=0.2)


def test_pixels_hold_a_vehicle_that_the_detector_misses():
    every = drive(MultiVehicleTracker(FLAT), 55, seen=lambda index: index < 30 or index > 45)
    held = [estimates[0] for estimates in every[31:45]]
    assert {one.mode for one in held} == {TrackMode.TRACKING}
    assert held[-1].box.centre[0] == pytest.approx(20 + 4 * 44 + 20, abs=3)
    alone = drive(
        MultiVehicleTracker(replace(FLAT, pixels=False)), 40, seen=lambda index: index < 30
    )
    assert alone[-1][0].mode is TrackMode.OCCLUDED


def test_a_vehicle_behind_something_is_occluded_and_comes_back_under_its_number():
    tracker = MultiVehicleTracker(FLAT)
    wall = slice(130, 190)
    numbers, modes = [], []
    for index in range(60):
        left = 20 + 4 * index
        frame = scene((left, 100, 40, 30))
        frame[:, wall] = 60
        hidden = wall.start <= left + 5 and left + 35 <= wall.stop
        partly = left + 40 > wall.start and left < wall.stop
        seen = [] if partly else [(left, 100, 40, 30)]
        estimates = tracker.step(frame, Detections.make(np.reshape(seen, (-1, 4))))
        numbers += [one.identity for one in estimates if one.mode is not TrackMode.TENTATIVE]
        if hidden:
            modes += [(one.mode, one.hidden_by) for one in estimates]
    assert set(numbers) == {1}
    assert set(modes) == {(TrackMode.OCCLUDED, SCENE_OCCLUDER)}
    assert estimates[0].mode is TrackMode.TRACKING


@pytest.mark.parametrize("shift", [(10, 8), (0, 28)])
def test_a_vehicle_with_two_boxes_has_one_number_and_two_vehicles_have_two(shift):
    tracker = MultiVehicleTracker(FLAT)
    for index in range(40):
        boxes = [(20 + 4 * index + dx, 100 + dy, 40, 30) for dx, dy in ((0, 0), shift)]
        estimates = tracker.step(scene(*boxes), Detections.make(boxes))
    assert tracker.last_identity == (1 if shift == (10, 8) else 2)
    assert sum(one.mode is TrackMode.TRACKING for one in estimates) == tracker.last_identity


def test_two_boxes_that_drive_as_one_and_part_later_have_two_numbers():
    tracker = MultiVehicleTracker(FLAT)
    for index in range(60):
        behind = max(0, index - 30)  # the second one brakes
        boxes = [(20 + 4 * index, 100, 40, 30), (30 + 4 * index - 2 * behind, 108, 40, 30)]
        estimates = tracker.step(scene(*boxes), Detections.make(boxes))
        if index == 30:
            assert tracker.last_identity == 1
    assert tracker.last_identity == 2
    assert sum(one.mode is TrackMode.TRACKING for one in estimates) == 2


def test_a_vehicle_that_leaves_is_lost_and_the_border_hides_it():
    tracker = MultiVehicleTracker(replace(FLAT, pixels=False))
    left, modes = -20, []
    for index in range(65):
        place = 200 - 4 * index
        seen = [(max(place, 0), 100, 40 + min(place, 0), 30)] if place > left else []
        estimates = tracker.step(GROUND, Detections.make(np.reshape(seen, (-1, 4))))
        modes += [(one.mode, one.hidden_by) for one in estimates if one.identity]
    assert modes[-1] == (TrackMode.LOST, BORDER_OCCLUDER)
    assert {mode for mode, _ in modes} == {TrackMode.TRACKING, TrackMode.LOST}
    assert not estimates


def test_a_hidden_vehicle_is_lost_and_forgotten_by_seconds():
    tracker = MultiVehicleTracker(replace(FLAT, lost_after=0.2, forgotten_after=0.2))
    drive(tracker, 30)
    modes = [
        [one.mode for one in tracker.step(np.full_like(GROUND, 60), Detections.none())]
        for _ in range(20)
    ]
    assert [TrackMode.OCCLUDED] in modes
    assert [TrackMode.LOST] in modes
    assert modes[-1] == []


def test_a_detection_that_stays_where_it_is_and_flickers_is_seldom_a_vehicle():
    confirmed = []
    for seed in range(20):
        tracker, rng = MultiVehicleTracker(FLAT), np.random.default_rng(seed)
        for index in range(100):
            where = np.append(60 + rng.normal(0, 2, 2), (12, 9))
            detections = Detections.make([where]) if index % 3 else Detections.none()
            tracker.step(GROUND, detections)
        confirmed.append(tracker.last_identity > 0)
    assert sum(confirmed) <= 2


def test_runs_repeat_bit_by_bit():
    first, second = (drive(MultiVehicleTracker(), 40, seen=lambda i: i % 7 != 0) for _ in range(2))
    assert repr(first) == repr(second)


def test_estimates_of_two_runs_are_equal_without_a_score_too():
    first = drive(MultiVehicleTracker(FLAT), 40, seen=lambda index: index < 35)
    second = drive(MultiVehicleTracker(FLAT), 40, seen=lambda index: index < 35)
    assert first[-1][0].score != first[-1][0].score  # NaN: nobody has seen it
    assert first == second


def test_a_vehicle_given_by_hand_that_a_detector_sees_ends_like_others():
    tracker = MultiVehicleTracker(FLAT)
    tracker.step(scene((20, 100, 40, 30)))
    tracker.add(Box(20, 100, 40, 30))
    every = drive(tracker, 75, right=lambda index: min(20 + 4 * index, 280))  # part of it has left
    assert [len(estimates) for estimates in every[:60]] == [1] * 60
    for _ in range(200):
        estimates = tracker.step(GROUND, Detections.none())
    assert estimates == ()


@pytest.mark.parametrize("value", [np.nan, np.inf, -1.0])
def test_a_vehicle_of_a_bad_state_is_dropped_counted_and_the_others_go_on(monkeypatch, value):
    tracker = MultiVehicleTracker(FLAT)
    boxes = [(40, 60, 40, 30), (200, 160, 40, 30)]
    tracker.step(scene(*boxes))
    for box in boxes:
        tracker.add(Box(*box))
    driven = Gaussians.driven

    def spoil(gaussians, elapsed, motion):
        gaussians = driven(gaussians, elapsed, motion)
        gaussians.covariance[gaussians.edges[:, 0] < 100, 1] = value
        return gaussians

    monkeypatch.setattr(Gaussians, "driven", spoil)
    kept, new = tracker.step(scene(*boxes), Detections.make(boxes))
    assert tracker.bad_states == 1
    assert (kept.identity, kept.mode) == (2, TrackMode.TRACKING)
    assert (new.identity, new.mode) == (0, TrackMode.TENTATIVE)  # it is detected anew


def test_vehicles_given_by_hand_need_no_detector():
    tracker = MultiVehicleTracker(FLAT)
    with pytest.raises(RuntimeError, match="frame"):
        tracker.add(Box(20, 100, 40, 30))
    tracker.step(scene((20, 100, 40, 30)))
    number = tracker.add(Box(20, 100, 40, 30), "van")
    for index in range(1, 30):
        (estimate,) = tracker.step(scene((20 + 2 * index, 100, 40, 30)))
    assert (estimate.identity, estimate.label, estimate.mode) == (number, "van", TrackMode.TRACKING)
    assert estimate.box.centre == pytest.approx((20 + 58 + 20, 115), abs=3)
    assert tracker.remove(number)
    assert not tracker.remove(number)
    with pytest.raises(InputError, match="outside"):
        tracker.add(Box(1000, 1000, 40, 30))


def test_numbers_go_on_after_a_reset_and_parameters_change_without_a_loss():
    tracker = MultiVehicleTracker(FLAT)
    drive(tracker, 20)
    tracker.reconfigure(replace(FLAT, seed=7, num_particles=20))
    assert tracker.seed == 7
    assert [one.identity for one in drive(tracker, 21)[-1]][:1] == [1]
    tracker.reset()
    assert drive(tracker, 21)[-1][0].identity > 1


def test_another_size_of_image_and_none_of_its_boxes_end_nothing():
    tracker = MultiVehicleTracker(FLAT)
    drive(tracker, 20)
    tracker.step(np.zeros((120, 160, 3), np.uint8), Detections.none())
    with pytest.raises(InputError):
        tracker.step(np.zeros((120, 160), np.uint8))


@settings(max_examples=30)
@given(
    st.lists(
        st.tuples(*[st.floats(allow_nan=True, allow_infinity=True, width=32)] * 5), max_size=12
    )
)
def test_no_detection_breaks_it(rows):
    tracker = MultiVehicleTracker()
    array = np.array(rows, dtype=float).reshape(-1, 5)
    for _ in range(3):
        for one in tracker.step(GROUND, Detections.make(array[:, :4], array[:, 4])):
            box = one.box
            assert np.isfinite([box.x, box.y, box.width, box.height, *one.velocity]).all()


def test_a_vehicle_given_by_hand_is_not_refuted_by_a_detector_that_does_not_see_it():
    tracker = MultiVehicleTracker(FLAT)
    parked = (200, 100, 40, 30)
    tracker.step(scene(parked), Detections.none())
    number = tracker.add(Box(*parked))
    for _ in range(120):
        (estimate,) = tracker.step(scene(parked), Detections.none())
    assert (estimate.identity, estimate.mode) == (number, TrackMode.TRACKING)


def test_a_reset_leaves_nothing_of_what_was_learnt():
    """Else a restart after a bad state could fail at once."""
    worn, new = MultiVehicleTracker(FLAT), MultiVehicleTracker(FLAT)
    drive(worn, 40, seen=lambda index: index % 5 > 0)
    worn.reset()
    first = drive(new, 30, seen=lambda index: index % 3 > 0)
    again = drive(worn, 30, seen=lambda index: index % 3 > 0)
    assert repr(
        [
            tuple(replace(one, serial=1, identity=min(one.identity, 1)) for one in found)
            for found in again
        ]
    ) == repr(first)


def test_vehicles_can_be_added_as_soon_as_all_was_reset():
    tracker = MultiVehicleTracker(FLAT)
    drive(tracker, 20)
    tracker.reset()
    number = tracker.add(Box(96, 100, 40, 30))
    (estimate,) = tracker.step(scene((96, 100, 40, 30)))
    assert (estimate.identity, estimate.mode) == (number, TrackMode.TRACKING)
