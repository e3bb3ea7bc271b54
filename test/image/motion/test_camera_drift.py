# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A camera that sways about its place stands; one that pans or turns does not."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_drift import CameraDrift
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion

EXTENT = (640, 360)
UPRIGHT = np.eye(2)


def shifted(x, y=0.0):
    return CameraMotion(UPRIGHT, np.array([x, y]))


def drifted(motions):
    drift = CameraDrift()
    for motion in motions:
        drift = drift.moved_on(motion, 1.0, EXTENT)
    return drift


def test_a_displacement_is_a_fraction_of_the_larger_side_and_fades_within_two_seconds():
    drift = drifted([shifted(6.4), *[CameraMotion()] * 60])
    assert drift.corners == pytest.approx(np.tile([0.01 / np.e, 0.0], (4, 1)))


def test_elapsed_periods_count():
    once = CameraDrift().moved_on(shifted(6.0), 1.0, EXTENT).moved_on(CameraMotion(), 3.0, EXTENT)
    assert once.corners == pytest.approx(drifted([shifted(6.0), *[CameraMotion()] * 3]).corners)


def test_a_jump_by_two_px_leaves_it_standing():
    assert drifted([shifted(-1.2, 1.6)]).stands


def test_a_camera_that__five_px_to_and_fro_stands():
    places = 5.0 * np.sin(np.arange(200) / 4)
    assert drifted(shifted(step) for step in np.diff(places)).stands


@pytest.mark.parametrize("speed", [0.3, 2.0])
def test_a_camera_that_pans_does_not_stand_once_it_has_moved_by_half_a_hundredth(speed):
    frames = int(3.2 / speed) + 4  # a little has faded by then
    assert drifted([shifted(speed)]).stands
    assert not drifted([shifted(speed)] * frames).stands


def test_a_camera_that_turns_about_the_middle_of_the_image_does_not_stand():
    angle = 0.02
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    middle = np.array(EXTENT) / 2
    # The middle stays, the corners move by 367 px times the angle.
    assert not drifted([CameraMotion(turn, middle - turn @ middle)]).stands


def test_one_that_has_panned_stands_again_when_that_has_faded():
    panned = [shifted(2.0)] * 10
    assert not drifted([*panned, *[CameraMotion()] * 90]).stands
    assert drifted([*panned, *[CameraMotion()] * 120]).stands
