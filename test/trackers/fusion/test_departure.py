# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A vehicle that has left: never taken to be back for a stranger, and found when it comes back."""

import numpy as np
import pytest
from fusion_samples import fusion
from street import HEIGHT, SIZE, START, WIDTH, Street, error, follow, vehicle

from vehicle_pf_tracker.image.correlation.canonical_patch import cut_patch
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.departure import Departure, Strangers

LEAVES = 62
"""The time at which the whole vehicle is outside."""


class Platoon(Street):
    """Twenty vehicles of the same paint drive behind it, the first after `gap` frames."""

    def __init__(self, gap, seed):
        super().__init__(seed=seed)
        self.gap = gap

    def frame(self, time):
        frame = super().frame(time).copy()
        for number in range(20):
            left = int(self.box(time - self.gap - 15 * number).x)
            if 0 <= left < WIDTH:
                part = vehicle()[:, : WIDTH - left]
                frame[int(START[1]) : int(START[1]) + SIZE[1], left : left + part.shape[1]] = part
        return frame


class Back(Street):
    """It leaves, waits outside, and drives backwards into the image."""

    turned = 75

    def box(self, time):
        return super().box(min(time, 2 * self.turned - time))


@pytest.mark.parametrize("gap", [20, 70])
def test_look_alikes_that_drive_behind_it_are_not_taken_for_it(gap):
    for seed in range(3):
        estimates = follow(fusion(seed=seed), Platoon(gap, seed), range(250))
        claimed = [e.mode is Mode.TRACKING for e in estimates]
        assert all(claimed[:56])
        assert np.mean(claimed[LEAVES:]) <= 0.02
        assert estimates[-1].mode is Mode.LOST
        assert estimates[-1].scalars()["regime"] == "left at the right"


def test_a_vehicle_that_comes_back_by_the_same_border_is_found():
    found = 0
    for seed in range(3):
        street = Back(seed=seed)
        estimates = follow(fusion(seed=seed), street, range(120))
        assert estimates[Back.turned].mode is Mode.LOST
        found += estimates[-1].mode is Mode.TRACKING and error(estimates[-1], street, 119) < 4
    assert found >= 2


PLACE = np.array([100.0, 60.0])


def peaked(x, height):
    """A response with one peak, at x and the height of `PLACE`."""
    patch = cut_patch(np.zeros((HEIGHT, WIDTH, 3), np.uint8), PLACE, np.ones(2), 64)
    view = View(patch, None, np.zeros((32, 32), np.float32))
    column, row = view.places(np.array([x, PLACE[1]]))
    view.response[row, column] = height
    return view


def left():
    """One that left at the left."""
    return Departure("", np.array([1.0, 0.0]), PLACE, np.full(2, 7.0), Strangers().level)


def test_the_velocity_of_a_return_is_per_period_though_frames_were_dropped():
    departure = left()
    for time in range(0, 18, 2):
        departure = departure.observed(peaked(100 + time, 0.9), 2.0)
    assert departure.returned[1] == pytest.approx([1.0, 0.0], abs=0.1)


def test_what_stands_does_not_return_though_the_camera_pans():
    """The background moves to the right by 2 px a frame, and with it the place of departure."""
    pan = CameraMotion(np.eye(2), np.array([2.0, 0.0]))
    for standing in (True, False):
        departure = left()
        for time in range(12):
            departure = departure.moved(pan)
            assert departure.position[0] == pytest.approx(PLACE[0] + 2 * (time + 1))
            x = 100 + (2 if standing else 4) * time
            departure = departure.observed(peaked(x, 0.9))
        assert (departure.returned is None) is standing


def returns(views, elapsed=1.0):
    """Frame by frame, whether one that left has come back."""
    departure = left()
    for view in views:
        departure = departure.observed(view, elapsed)
        yield departure.returned is not None


@pytest.mark.parametrize(
    ("speed", "height", "found"),
    [(2.0, 0.9, True), (-2.0, 0.9, False), (0.0, 0.9, False), (2.0, 0.7, False)],
)
def test_one_that_left_is_found_only_as_it_moves_inwards(speed, height, found):
    assert any(returns(peaked(100 + speed * time, height) for time in range(10))) is found


def test_what_is_first_seen_far_inside_is_another_one():
    """One and a half of its sizes are 10.5 px."""
    found = [any(returns(peaked(x + 2 * time, 0.9) for time in range(10))) for x in (109, 112)]
    assert found == [True, False]


def test_a_return_has_to_look_more_like_it_than_strangers_did():
    strangers = Strangers()
    for time in range(3):
        strangers = strangers.measured(peaked(120.0, 0.9 if time else 0.4), PLACE, np.full(2, 8.0))
    assert strangers.level == pytest.approx(0.9, abs=0.01)
    strangers = strangers.measured(peaked(103.0, 1.2), PLACE, np.full(2, 8.0))
    assert strangers.level < 0.9  # that is the vehicle itself
