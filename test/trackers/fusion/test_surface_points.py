# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Points on a vehicle: a turn or a change of size keeps them, an occluder ends them."""

import cv2
import numpy as np
import pytest
from fusion_samples import texture

from vehicle_pf_tracker.image.correlation.canonical_patch import cut_patch
from vehicle_pf_tracker.image.motion.box_motion import shared_turn
from vehicle_pf_tracker.trackers.fusion.surface_points import SurfacePoints

SIZE = np.array([40.0, 40.0])
START = np.array([80.0, 120.0])


FINE = {"blur": 1.5, "gain": 4.0}
ROAD, VEHICLE = texture(1, **FINE), texture(2, 80, 80, **FINE)
OCCLUDER = texture(3, 80, 240, **FINE)


def frame(centre, scale=(1.0, 1.0), background=ROAD):
    """The vehicle, 40 px of a texture times `scale`, around `centre` on the road."""
    picture = background.copy()
    matrix = np.array([
        [scale[0], 0, centre[0] - 0.5 - 39.5 * scale[0]],
        [0, scale[1], centre[1] - 0.5 - 39.5 * scale[1]],
    ])  # fmt: skip
    warped = cv2.warpAffine(VEHICLE, matrix, (320, 240))
    half = SIZE * scale / 2
    left, top = np.rint(np.array(centre) - half).astype(int)
    right, bottom = np.rint(np.array(centre) + half).astype(int)
    picture[top:bottom, left:right] = warped[top:bottom, left:right]
    return picture


def patch_of(picture, centre, size=SIZE):
    return cut_patch(picture, np.array(centre, float), 40.0 / size, 128)


def share_living(points):
    return points.points.alive.mean()


class Drive:
    """Tracks the points of a vehicle whose position and size are known."""

    def __init__(self, speed=2.0, growth=(0.0, 0.0)):
        self.points, self.time = SurfacePoints(), 0
        self.speed, self.growth = np.array([speed, 0.5 * speed]), np.array(growth)
        self.points = self.points.kept(patch_of(frame(START), START), START)
        self.points = self.points.renewed(START, SIZE)

    @property
    def centre(self):
        return START + self.speed * self.time

    @property
    def scale(self):
        return np.exp(self.growth * self.time)

    def drive(self, frames, occlude=None, *, whole=True):
        """Show so many frames; returns the share that lives in the last of them."""
        return [self.step(occlude, whole=whole) for _ in range(frames)][-1]

    def step(self, occlude=None, *, whole=True):
        """Show the next frame, with `occlude` painted over it; returns the share that lives."""
        self.time += 1
        picture = frame(self.centre, self.scale)
        if occlude is not None:
            occlude(picture, self.centre)
        patch = patch_of(picture, self.centre, SIZE * self.scale)
        size = SIZE * self.scale
        self.points = self.points.tracked(patch, self.centre, size)
        living = share_living(self.points)
        self.points = self.points.renewed(self.centre, size, whole=whole)
        self.points = self.points.kept(patch, self.centre)
        return living


def cover(left, width):
    """Paint an occluder from `left` px of the vehicle's centre on."""

    def paint(picture, centre):
        x = round(centre[0]) + left
        picture[:, x : x + width] = OCCLUDER[:, :width]

    return paint


def test_all_points_of_a_translated_texture_survive():
    drive = Drive()
    living = [drive.step() for _ in range(25)]
    assert living == pytest.approx([1.0] * 25, abs=0.15)
    assert drive.points.stretch == pytest.approx([0, 0], abs=2e-3)


@pytest.mark.parametrize(
    ("left", "low", "high"), [(-80 + 0, 0.2, 0.75), (-40, 0.0, 0.25)], ids=["half", "whole"]
)
def test_an_occluder_ends_the_points_that_it_covers(left, low, high):
    drive = Drive()
    drive.drive(12)
    assert low <= drive.drive(3, cover(left, 80), whole=False) <= high


@pytest.mark.parametrize("degrees", [20, -40])
def test_the_turn_of_places_is_found_among_strays(degrees):
    ends = np.linspace(-0.4, 0.4, 6)
    places = np.stack(np.meshgrid(ends, ends), axis=-1).reshape(-1, 2)
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    moved = places @ turn
    moved[:4] += 0.5
    found = moved - places @ shared_turn(places, moved, 0.2)
    assert np.hypot(*found[4:].T).max() < 0.12
    assert np.hypot(*found[:4].T).min() > 0.4


def test_few_places_hardly_turn():
    places = np.array([[0.1, 0.1], [0.12, 0.1]])
    assert shared_turn(places, 2 * places, 0.2) == pytest.approx(np.eye(2), abs=0.1)


def test_points_of_a_turning_vehicle_survive():
    """Four degrees a frame: after ten frames its corners are a quarter of the side away."""
    points, position = SurfacePoints(), START
    for frames in range(11):
        matrix = cv2.getRotationMatrix2D((float(START[0]), float(START[1])), 4.0 * frames, 1.0)
        picture = cv2.warpAffine(ROAD, matrix, ROAD.shape[1::-1])
        patch = patch_of(picture, position)
        if frames:
            points = points.tracked(patch, position, SIZE)
            assert share_living(points) > 0.6
        points = points.renewed(position, SIZE)
        points = points.kept(patch, position)


def test_what_stays_behind_with_a_standing_part_ends():
    """Where the box leaves its points behind, they hold on to what is not the vehicle."""
    drive = Drive()
    drive.drive(8)
    drive.speed = np.array([8.0, 0.0])
    patch = patch_of(frame(drive.centre), drive.centre)
    for number in range(1, 3):
        ahead = drive.centre + np.array([8.0 * number, 0.0])
        drive.points = drive.points.kept(
            patch, ahead
        )  # so that the search starts where the points are
        drive.points = drive.points.tracked(patch, ahead, SIZE)
    assert share_living(drive.points) < 0.1


@pytest.mark.parametrize("growth", [(0.02, 0.02), (-0.02, -0.02), (0.02, 0.0), (0.0, -0.015)])
def test_the_stretch_of_a_zoomed_texture_is_its_growth(growth):
    drive = Drive(speed=1.0, growth=growth)
    stretches = []
    for _ in range(8):
        drive.step()
        stretches.append(drive.points.stretch)
    assert np.median(stretches, axis=0) == pytest.approx(growth, abs=4e-3)


def test_a_flat_vehicle_tells_nothing():
    flat = np.full((240, 320, 3), 90, np.uint8)
    points = SurfacePoints()
    points = points.kept(patch_of(flat, START), START)
    points = points.renewed(START, SIZE)
    for _ in range(8):
        noise = np.random.default_rng(0).integers(0, 256, flat.shape).astype(np.uint8)
        points = points.tracked(patch_of(noise, START), START, SIZE)
        points = points.kept(patch_of(noise, START), START)
    assert share_living(points) < 0.3
    assert points.stretch.tolist() == [0.0, 0.0]


def test_points_are_replaced_every_five_frames_but_not_on_an_occluder():
    drive, ages = Drive(), []
    for _ in range(12):
        drive.drive(1)
        ages.append(drive.points.points.age)
    assert ages == [1, 2, 3, 4, 0] * 2 + [1, 2]
    drive.drive(5, cover(-40, 80), whole=False)
    assert drive.points.points.age == 7


def test_points_that_are_all_lost_are_replaced_in_time():
    drive = Drive()
    drive.points.points.alive[:] = False
    assert drive.drive(4) == 0
    assert drive.drive(2) > 0.85


def test_restarting_discards_all_points():
    drive = Drive(growth=(0.01, 0.01))
    drive.drive(12)
    drive.points = drive.points.restarted()
    assert drive.points.points is None
    assert drive.points.stretch.tolist() == [0.0, 0.0]
    drive.points = drive.points.renewed(drive.centre, SIZE)
    assert share_living(drive.points) == 1


def first_motion(before, after, size=SIZE):
    points = SurfacePoints()
    points = points.kept(patch_of(before, START, size), START)
    return points.first_motion(patch_of(after, START, size), size)


@pytest.mark.parametrize(
    ("move", "larger"), [((5.0, 0.0), 1), ((-6.0, 4.0), 1), ((11.0, -7.0), 1), ((6.0, 0.0), 2)]
)
def test_the_first_motion_is_that_of_what_moves_in_the_box(move, larger):
    """The last box is twice as large as the vehicle in it: the background stands."""
    found = first_motion(frame(START), frame(START + move), larger * SIZE)
    assert found == pytest.approx(move, abs=0.5)


@pytest.mark.parametrize("after", [ROAD, texture(77, **FINE)], ids=["stand", "disagree"])
def test_points_that_stand_or_disagree_give_no_first_motion(after):
    assert first_motion(ROAD, after) is None


def test_noise_of_a_magnified_vehicle_is_no_first_motion():
    """A px of the frame is 2.6 canonical ones."""
    small, move = np.array([20.0, 12.0]), np.array([1.0, 0.0])
    before, after = frame(START), frame(START + move)
    assert first_motion(before, after, SIZE) is None
    assert first_motion(before, after, small) is None
    assert first_motion(before, frame(START + 3 * move), small) is not None


@pytest.mark.parametrize("every", [2, 3])
def test_frames_may_be_left_out(every):
    """The stretch is then that of all frames since the patch that was kept."""
    drive = Drive(speed=2.0, growth=(0.01, 0.01))
    stretches = []
    for _ in range(8):
        drive.time += every - 1
        living = drive.step()
        stretches.append(drive.points.stretch)
    assert living > 0.4
    assert np.median(stretches, axis=0) == pytest.approx([0.01 * every] * 2, abs=5e-3)
