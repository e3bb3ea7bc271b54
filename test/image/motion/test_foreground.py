# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Outlines of what moves before a still background: rectangles on noise, to the pixel."""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.foreground import Foreground
from vehicle_pf_tracker.image.motion.small_grey import SmallGrey

SIZE = np.array([24.0, 14.0])


NOISE = np.random.default_rng(0).integers(60, 140, (120, 200)).astype(np.uint8)
ROAD = cv2.GaussianBlur(NOISE, (0, 0), 2.0)


def scene(*boxes, zoom=1.0, level=230):
    """A road with bright rectangles, each of left, top, right and bottom px."""
    picture = ROAD.copy()
    for left, top, right, bottom in boxes:
        picture[top:bottom, left:right] = level
    return SmallGrey(picture, zoom)


def watched(zoom=1.0, frames=40):
    foreground = Foreground()
    for time in range(frames):
        left = 20 + 2 * time
        foreground.keep(scene((left, 50, left + 24, 64), zoom=zoom), stands=True)
    return foreground, np.array([20 + 2 * (frames - 1) + 12, 57]) / zoom


@pytest.mark.parametrize("zoom", [1.0, 0.5])
def test_the_outline_is_that_of_what_moves(zoom):
    foreground, centre = watched(zoom)
    outline = foreground.outline(centre, SIZE / zoom)
    assert outline.centre == pytest.approx(centre, abs=1 / zoom)
    assert outline.size == pytest.approx(SIZE / zoom, abs=2 / zoom)


@pytest.mark.parametrize("zoom", [1.0, 0.5])
def test_what_moves_around_a_box_ends_at_its_sides(zoom):
    foreground, centre = watched(zoom)
    around = foreground.around(centre, SIZE / zoom)
    assert np.abs(around.beyond(centre, SIZE / zoom) * SIZE).max() < 1
    # Four px of a box that is wider by them are beside the vehicle.
    wider = around.beyond(centre - np.array([2, 0]) / zoom, np.array([28.0, 14.0]) / zoom)
    assert wider[0, 0] * 28 == pytest.approx(-4, abs=1)


def test_a_box_of_some_frames_ago_is_seen_there():
    foreground, centre = watched()
    before = centre - (6, 0)
    assert foreground.outline(before, SIZE, ago=3).centre == pytest.approx(before, abs=1)


def test_a_moving_camera_leaves_no_background():
    foreground, centre = watched()
    assert foreground.is_known
    foreground.keep(scene((100, 50, 124, 64)), stands=False)
    assert not foreground.is_known
    assert foreground.outline(centre, SIZE) is None


@pytest.mark.parametrize("zoom", [1.0, 0.5])
def test_what_is_kept_is_carried_along_with_a_camera_that_sways(zoom):
    """It jumps by 3 and -2 px of the reduced frame."""
    foreground, centre = watched(zoom)
    jump = np.array([3.0, -2.0])
    left = 20 + 2 * 40
    moved = np.roll(scene((left, 50, left + 24, 64), zoom=zoom).image, (-2, 3), axis=(0, 1))
    camera = CameraMotion(np.eye(2), jump / zoom)
    foreground.keep(SmallGrey(moved, zoom), camera, stands=True)
    centre = centre + (np.array([2.0, 0.0]) + jump) / zoom
    assert foreground.is_known
    outline = foreground.outline(centre, SIZE / zoom)
    assert outline.centre == pytest.approx(centre, abs=1 / zoom)
    assert outline.size == pytest.approx(SIZE / zoom, abs=2 / zoom)
    # Frames of before are where the camera sees them now.
    before = centre - np.array([6.0, 0.0]) / zoom
    assert foreground.outline(before, SIZE / zoom, ago=3).centre == pytest.approx(
        before, abs=1 / zoom
    )


def test_a_background_that_was_learnt_is_carried_along_too():
    foreground, _ = watched()
    foreground.learn_background()
    moved = np.roll(scene((100, 50, 124, 64)).image, 3, axis=1)
    foreground.keep(
        SmallGrey(moved, 1.0), CameraMotion(np.eye(2), np.array([3.0, 0.0])), stands=True
    )
    # What has come in at the rim was never seen, and may move.
    boxes = foreground.boxes()
    box = boxes[(boxes[:, 1] - boxes[:, 0]).prod(axis=1).argmax()]
    assert box == pytest.approx(np.array([[103.0, 50.0], [127.0, 64.0]]), abs=1)


def test_a_slow_vehicle_is_no_part_of_the_background_once_the_camera_has_stood_for_long():
    """It takes 48 frames for its length, most of two seconds."""
    foreground = Foreground()
    for time in range(200):
        left = 20 + time // 2
        foreground.keep(scene((left, 50, left + 24, 64)), stands=True)
    outline = foreground.outline(np.array([left + 12.0, 57.0]), SIZE)
    assert outline.size == pytest.approx(SIZE, abs=2)


@pytest.mark.parametrize(
    "latest", [scene((0, 30, 200, 90)), SmallGrey(ROAD[:100], 1.0)], ids=["wall", "other size"]
)
def test_what_reaches_too_far_or_has_another_size_has_no_outline(latest):
    """A wall of moving pixels is no vehicle of the box's size."""
    foreground, centre = watched()
    foreground.keep(latest, stands=True)
    assert foreground.outline(centre, SIZE) is None


def test_a_few_frames_are_no_background():
    foreground, centre = watched(frames=12)
    assert foreground.outline(centre, SIZE) is None


@pytest.mark.parametrize(
    "centre", [(50.0, 57.0), (0.0, 0.0), (199.0, 119.0), (-50.0, 60.0), (500.0, 500.0)]
)
def test_beside_the_vehicle_and_beyond_the_border_nothing_moves(centre):
    assert watched()[0].outline(np.array(centre), SIZE) is None


def test_all_that_moves_has_a_box_now_and_in_the_frames_before():
    foreground, _ = watched()
    foreground.keep(scene((100, 50, 124, 64), (20, 90, 50, 110)), stands=True)
    foreground.learn_background()
    history = dict(foreground.history())
    assert list(history) == [0.0, 16.0, 32.0]
    assert history[16.0].shape == (1, 2, 2)
    assert history[16.0].mean(axis=1)[0] == pytest.approx([20 + 2 * 24 + 12, 57], abs=1)
    boxes = sorted(foreground.boxes().reshape(-1, 4).tolist())
    assert boxes[0] == pytest.approx([20, 90, 50, 110], abs=2)
    assert boxes[1] == pytest.approx([100, 50, 124, 64], abs=2)
    assert foreground.extent.tolist() == [200, 120]


def test_near_a_box_only_what_is_within_three_of_its_longer_sides_has_a_box():
    foreground, _ = watched()
    foreground.keep(scene((100, 50, 124, 64), (20, 90, 50, 110)), stands=True)
    foreground.learn_background()
    # Around x 150, by 3 x 20 px: from 90 on.
    (near,) = foreground.boxes_near(np.array([150.0, 60.0]), np.array([20.0, 10.0]))
    assert near.ravel() == pytest.approx([100, 50, 124, 64], abs=2)
    assert not len(foreground.boxes_near(np.array([400.0, 60.0]), np.array([20.0, 10.0])))
