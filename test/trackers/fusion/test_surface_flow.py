# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The share of a vehicle's surface that moves with it: an occluder lowers it, a turn does not."""

import numpy as np
import pytest
from fusion_samples import paste_turned, texture

from vehicle_pf_tracker.image.correlation.canonical_patch import cut_patch
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.surface_flow import SurfaceFlow

SIZE = np.array([40.0, 40.0])
START = np.array([80.0, 120.0])


class Textures:
    """Textures of road, vehicle and occluder."""

    def __init__(self, seed=0):
        self.road, self.occluder = texture(10 * seed + 1), texture(10 * seed + 3)
        self.vehicle = texture(10 * seed + 2, 40, 40)


USUAL = Textures()
SEVERAL = [Textures(seed) for seed in range(8)]


def picture_of(centre, degrees=0.0, textures=USUAL):
    """The vehicle on the road, turned by so much."""
    return paste_turned(textures.road, textures.vehicle, centre, degrees)


class Drive:
    """Shows a vehicle whose position is known, frame by frame."""

    def __init__(self, speed=(2.0, 0.0), spin=0.0, textures=USUAL):
        self.flow, self.time = SurfaceFlow(), 0
        self.textures = textures
        self.speed, self.spin = np.array(speed), spin
        self._keep(self._patch())

    @property
    def centre(self):
        return START + self.speed * self.time

    def _patch(self, occlude=None):
        picture = picture_of(self.centre, self.spin * self.time, self.textures)
        if occlude is not None:
            occlude(picture, self.time)
        return cut_patch(picture, self.centre, 40.0 / SIZE, 128)

    def _keep(self, patch):
        self.flow = self.flow.kept(patch, self.centre, SIZE)

    def step(self, occlude=None, *, is_low=False):
        self.time += 1
        patch = self._patch(occlude)
        self.flow = self.flow.judged(patch, self.centre, SIZE, is_low=is_low)
        self._keep(patch)
        return self.flow.share

    def drive(self, frames, occlude=None):
        return [self.step(occlude) for _ in range(frames)][-1]


def wall(left, right=320, textures=USUAL):
    """A wall that stands in these columns, with the same texture all the time."""

    def paint(picture, _):
        picture[:, left:right] = textures.occluder[:, left:right]

    return paint


def test_all_of_a_vehicle_that_drives_on_moves_with_it():
    drive = Drive()
    shares = [drive.step() for _ in range(20)]
    assert min(shares[4:]) > 0.9


def test_a_standing_wall_leaves_about_the_share_that_is_visible():
    """After 30 frames the vehicle spans columns 120 to 160."""
    quarter, half, most = (Drive().drive(30, wall(left)) for left in (150, 140, 130))
    assert 0.5 < quarter < 0.9
    assert 0.35 < half < 0.65
    assert most < 0.25


def test_nothing_moves_with_a_vehicle_behind_a_wall():
    assert Drive().drive(30, wall(100)) < 0.1


def test_a_lorry_that_drives_by_takes_points_along():
    """It comes from the front, and covers the vehicle from frame 14 on, and wholly from 18 to 28.

    Flow takes some of its texture for the vehicle's, since it looks for matches close by first.
    """

    before, behind = [], []
    for textures in SEVERAL:
        drive = Drive(textures=textures)
        before.append(drive.drive(13, lorry_of(textures)))
        behind += [drive.step(lorry_of(textures)) for _ in range(14)]
    assert np.mean(before) > 0.9
    assert np.mean(behind) < 0.8


def lorry_of(textures):
    def lorry(picture, time):
        left = 220 - 7 * time
        first, last = max(left, 0), min(left + 140, 320)
        picture[:, first:last] = textures.occluder[:, first - left : last - left]

    return lorry


def plain_lorry(picture, time):
    """It comes from behind by 20 px per frame and covers the vehicle's half in frame 12."""
    picture[:, : max(20 * time - 116, 0)] = 40


def test_flow_that_has_failed_is_not_believed_where_the_filter_hardly_responds():
    """Flow finds no lorry as far away as it was, and takes it for a part of the vehicle."""
    believed, doubted = [], []
    for textures in SEVERAL:
        for is_low, flows in ((False, believed), (True, doubted)):
            drive = Drive(textures=textures)
            drive.drive(11)
            drive.step(plain_lorry, is_low=is_low)
            flows.append(drive.flow)
    assert all(flow.is_reliable for flow in believed)
    assert np.mean([flow.share for flow in believed]) > 0.85
    assert not any(flow.is_reliable for flow in doubted)


def test_what_hardly_moves_is_not_told_from_what_stands_where_the_filter_hardly_responds():
    """In 8 frames it moves by 1.6 px, of the 2 that tell: a wall there would move along as well."""
    drive = Drive(speed=(0.2, 0.0))
    drive.drive(19)
    assert drive.step() > 0.9
    assert drive.flow.is_reliable
    drive.step(is_low=True)
    assert not drive.flow.is_reliable


def test_flow_that_shows_an_occluder_is_believed_whatever_it_explains():
    drive = Drive()
    drive.drive(29, wall(130))
    assert drive.step(wall(130), is_low=True) < 0.25
    assert drive.flow.is_reliable


@pytest.mark.parametrize("spin", [3.0, -4.0])
def test_a_vehicle_that_turns_keeps_its_surface(spin):
    drive = Drive(spin=spin)
    drive.drive(19)
    assert drive.step(is_low=True) > 0.7
    assert drive.flow.is_reliable


def panned_share(textures, *, known):
    """Behind a wall; the camera pans with the vehicle, which stays where it is in the image."""
    flow = SurfaceFlow()
    for time in range(12):
        picture = picture_of(START + np.array([3.0 * time, 0.0]), textures=textures)
        if time > 5:
            wall(90, textures=textures)(picture, time)
        patch = cut_patch(np.roll(picture, -3 * time, axis=1), START, 40.0 / SIZE, 128)
        if known:
            flow = flow.moved(CameraMotion(shift=np.array([-3.0, 0.0])))
        flow = flow.judged(patch, START, SIZE).kept(patch, START, SIZE)
    return flow.share


def test_a_wall_stands_in_the_scene_and_not_in_the_image():
    assert max(panned_share(textures, known=True) for textures in SEVERAL) < 0.2
    assert np.mean([panned_share(textures, known=False) for textures in SEVERAL]) > 0.5


def test_without_an_earlier_patch_flow_tells_nothing():
    flow = SurfaceFlow()
    patch = cut_patch(USUAL.road, START, 40.0 / SIZE, 128)
    flow = flow.judged(patch, START, SIZE)
    assert not flow.is_reliable
    assert flow.share == 1.0


def test_where_little_usually_moves_with_it_flow_tells_nothing():
    drive = Drive()
    assert drive.drive(12, wall(0)) == 1.0
    assert not drive.flow.is_reliable


def test_restarting_forgets_patches_but_not_the_usual_share():
    drive = Drive()
    drive.drive(30, wall(140))
    drive.flow = drive.flow.restarted()
    assert drive.flow.share == 1.0
    drive.step()
    assert not drive.flow.is_reliable
    assert drive.step() == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("side", [256, 128])
def test_the_middle_of_a_wide_patch_will_do(side):
    drive = Drive()
    drive.drive(10)
    patch = cut_patch(picture_of(drive.centre), drive.centre, 40.0 / SIZE, side).middle(128)
    assert drive.flow.judged(patch, drive.centre, SIZE).share > 0.8


def test_a_share_is_the_same_whatever_flow_was_measured_before():
    def share(textures):
        drive = Drive(textures=textures)
        for _ in range(3):
            drive.step()
        return drive.flow.latest

    first = share(SEVERAL[1])
    share(SEVERAL[2])
    assert share(SEVERAL[1]) == first
