# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A bright square of 20 px on a noisy road, before a camera that pans by 2 px per frame."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.panned_frames import PannedFrames
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

ROAD = np.random.default_rng(0).integers(60, 140, (120, 400)).astype(np.uint8)
PAN = CameraMotion(np.eye(2), np.array([-2.0, 0.0]))
PERIOD = 0.1


def shown(count, speed, zoom=1.0, size=20):
    """Frames of a square that drives by `speed` px per frame on the road; its place in the last."""
    frames = PannedFrames()
    for number in range(count):
        picture = ROAD.copy()
        left = 40 + speed * number
        picture[50 : 50 + size, left : left + size] = 250
        small = SmallGrey(picture[:, 2 * number : 2 * number + 240], zoom)
        frames.keep(small, CameraMotion(PAN.turn, PAN.shift / zoom), PERIOD)
    return frames, left - 2 * (count - 1)


def test_what_drives_is_found_where_it_is():
    """In the .2 s since the youngest frame that is compared with it has driven 24 px."""
    frames, left = shown(13, speed=12)
    ((low, high),) = frames.boxes(joined=4, least=100)
    assert low == pytest.approx([left, 50], abs=1)
    assert high == pytest.approx([left + 20, 70], abs=1)


def test_what_stands_on_the_road_does_not_move():
    frames, _ = shown(13, speed=0)
    assert len(frames.boxes(joined=4, least=10)) == 0


def test_boxes_are_in_px_of_the_whole_frame():
    frames, left = shown(13, speed=12, zoom=0.5)
    ((low, high),) = frames.boxes(joined=8, least=400)
    assert low == pytest.approx([2 * left, 100], abs=2)
    assert high == pytest.approx([2 * left + 40, 140], abs=2)


def test_a_smaller_thing_is_left_out():
    frames, _ = shown(13, speed=12)
    assert len(frames.boxes(joined=4, least=600)) == 0


def test_half_a_second_tells_nothing():
    """Of frames kept at 0, .2 and .4 s three are older than a sixth of a second at .6 s."""
    frames, _ = shown(6, speed=12)
    assert len(frames.boxes(joined=4, least=100)) == 0
    frames, _ = shown(7, speed=12)
    assert len(frames.boxes(joined=4, least=100)) == 1


def test_frames_of_another_size_begin_anew():
    frames, _ = shown(13, speed=12)
    frames.keep(SmallGrey(ROAD[:, :100], 1.0), PAN, PERIOD)
    assert len(frames.boxes(joined=4, least=1)) == 0


def test_an_image_that_changes_all_over_tells_nothing():
    """A flash, or a motion of the camera that was not measured."""
    frames, _ = shown(13, speed=12)
    frames.keep(SmallGrey(255 - ROAD[:, 26:266], 1.0), PAN, PERIOD)
    assert len(frames.boxes(joined=4, least=1)) == 0
