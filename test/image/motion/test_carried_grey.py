# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A frame carried along with a camera: a ramp of grey levels, which shows where each px came from.

At x of the frame of before it has level 2 x. Bilinear sampling of a ramp is exact.
"""

import math

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.carried_grey import CarriedGrey
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

RAMP = np.tile(np.arange(0, 200, 2, dtype=np.uint8), (60, 1))
INNER = slice(20, 40), slice(30, 50)


def carried(*motions, image=RAMP, zoom=1.0):
    grey = CarriedGrey(SmallGrey(image, zoom))
    for turn, shift in motions:
        grey.carry(CameraMotion(np.asarray(turn, float), np.asarray(shift, float)))
    return grey


def test_a_frame_that_was_not_carried_is_the_frame_itself():
    assert np.shares_memory(carried().image, RAMP)


@pytest.mark.parametrize("zoom", [1.0, 0.5])
def test_a_shift_of_the_whole_frame_moves_the_reduced_one_by_as_much(zoom):
    """By 3 px of the reduced frame to the right: there is what was 3 px to the left."""
    seen = carried((np.eye(2), (3 / zoom, 0)), zoom=zoom).image
    assert np.array_equal(seen[:, 3:], RAMP[:, :-3])
    # What has come in was never seen: the rim is repeated.
    assert not seen[:, :3].any()


def test_shifts_there_and_back_blur_nothing():
    """Seven times by a third of a px: rounded in each, a frame would be smooth."""
    dots = np.zeros((60, 100), np.uint8)
    dots[::2, ::2] = 255
    motions = [(np.eye(2), (1 / 3, 0)), (np.eye(2), (-1 / 3, 0))] * 7
    assert np.array_equal(carried(*motions, image=dots).image, dots)


def test_a_turn_is_about_the_corner_and_shifts_are_turned_with_it():
    """By 90 degrees after a shift by 5: (x, y) is at (-y, x + 5), or (55 - y, x + 5) at last."""
    quarter = [[0, -1], [1, 0]]
    seen = carried((np.eye(2), (5, 0)), (quarter, (0, 0)), (np.eye(2), (55, 0))).image
    # Row 25 shows x = 20, whatever the column.
    assert (seen[25, 10:50] == 40).all()


def test_a_zoom_in_spreads_the_frame():
    """Twice as large: at 40 is what was at 20, and at 41 what is between two px."""
    seen = carried((2 * np.eye(2), (0, 0))).image
    assert seen[20, 40] == 40
    assert seen[20, 41] == 41


def test_a_piece_is_that_of_the_whole_frame():
    angle = 0.01
    turn = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    grey = carried((turn, (2.3, -1.6)), (np.eye(2), (0.4, 0.2)))
    whole = grey.image[INNER].astype(int)
    # Places are rounded to a 32nd px, from the corner of what is asked for.
    assert np.abs(grey.piece(*INNER).astype(int) - whole).max() <= 1
