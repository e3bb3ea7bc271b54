# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Moments of a box of 20 x 10 px."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.small_grey import SmallColour
from vehicle_pf_tracker.trackers.fusion.moments import Moment, is_due, moved

SIZE = np.array([20.0, 10.0])
RAMP = np.tile(np.arange(100, dtype=np.uint8), (50, 1))


def small(grey, zoom):
    return SmallColour(np.repeat(grey[..., None], 3, axis=2), zoom)


def moment(x, y=20.0):
    return Moment.of_frame(small(RAMP, 1.0), np.array([float(x), y]), SIZE)


def is_due_at(moments, x, y=20.0):
    return is_due(moments, np.array([float(x), y]), SIZE)


def test_the_box_moves_on_by_an_eighth_of_its_size():
    assert is_due_at((), 30)
    first = (moment(30),)
    # .12 of 20 px are 2.4, of 10 px 1.2.
    assert not is_due_at(first, 32)
    assert is_due_at(first, 33)
    assert is_due_at(first, 30, 21.5)


def test_a_box_that_moves_with_the_camera_stands():
    first = moved((moment(30),), CameraMotion(shift=np.array([5.0, 0.0])))
    assert not is_due_at(first, 35)
    assert is_due_at(first, 30)


def test_the_background_is_where_the_camera_has_left_it():
    """The camera moves by 5 px between the first and the second, by 2 after that."""
    one, two = moment(30), moment(30)
    (first,) = moved((one,), CameraMotion(shift=np.array([5.0, 0.0])))
    first, second = moved((first, two), CameraMotion(shift=np.array([2.0, 1.0])))
    place = np.array([10.0, 10.0])
    assert first.background_in(second, place) == pytest.approx([15, 10])
    assert second.background_in(first, place) == pytest.approx([5, 10])
    assert one.background_in(two, place) is place


def test_cells_show_the_same_place_in_a_frame_and_in_a_patch():
    """The middle of px `n` is at n + .5 px, where a ramp has the value n."""
    first = np.array([10.5, 5.5])
    step = np.array([2.0, 1.0])
    assert moment(0).cells(first, step, (4, 2))[..., 1].tolist() == [[10, 12, 14, 16]] * 2
    # The left upper corner of the patch is at (5, 0) px.
    image = np.zeros((10, 10, 3), np.uint8)
    patch = Patch(image, RAMP[:10, 5:15], np.array([10.0, 5.0]), np.ones(2))
    cut = Moment.of_patch(patch, np.zeros(2), SIZE, 0.5)
    assert cut.cells(first, step, (2, 2)).tolist() == [[10, 12]] * 2
    assert cut.time == 0.5
    half = Moment.of_frame(small(RAMP[::2, ::2], 0.5), np.zeros(2), SIZE)
    # Its px are of two, whose middle is at the even ones + 1.
    assert half.cells(np.array([11.0, 5.0]), step, (3, 1))[..., 1].tolist() == [[10, 12, 14]]
