# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shake, flicker, light and noise, each by itself; and truth that moves with the picture."""

from dataclasses import replace

import numpy as np
import pytest

from laboratory.scenes import make_scene
from laboratory.scenes.light import Cloud, CloudyCamera
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.cameras import SHAKE_MARGIN, Disturbance, OutdoorCamera

CALM = Disturbance(0.0, 0.0, 0.0)
SHAKY = Disturbance(0.0, 3.0, 0.0)


def ramp(height=80, width=100):
    """Level = column + 2 rows, so that a level tells its place."""
    rows, columns = np.indices((height, width))
    return np.repeat((columns + 2 * rows)[..., np.newaxis], 3, axis=2).astype(np.float32) / 2


def test_a_calm_camera_shows_the_stage_without_its_margin():
    frame = OutdoorCamera(CALM, 0).capture(ramp(), 5)
    expected = np.rint(ramp()[SHAKE_MARGIN:-SHAKE_MARGIN, SHAKE_MARGIN:-SHAKE_MARGIN])
    np.testing.assert_array_equal(frame, expected)


@pytest.mark.parametrize("index", [0, 3, 11])
def test_a_shaken_picture_lies_where_the_offset_says(index):
    camera = OutdoorCamera(SHAKY, 4)
    x, y = camera.offset(index)
    assert (x, y) != (SHAKE_MARGIN, SHAKE_MARGIN)
    frame = camera.capture(ramp(), index)
    assert frame.shape == (80 - 2 * SHAKE_MARGIN, 100 - 2 * SHAKE_MARGIN, 3)
    rows, columns = np.indices(frame.shape[:2])
    expected = (columns + x + 2 * (rows + y)) / 2
    assert np.abs(frame[..., 0] - expected).max() <= 0.51


def test_noise_is_white_and_has_its_deviation():
    camera = OutdoorCamera(Disturbance(8.0, 0.0, 0.0), 2)
    one, two = (
        camera.capture(np.full((224, 224, 3), 120, np.float32), index).astype(float) - 120
        for index in (0, 1)
    )
    assert one.mean() == pytest.approx(0, abs=0.1)
    assert one.std() == pytest.approx(8, rel=0.02)
    assert (np.abs(one) > 16.5).mean() == pytest.approx(0.0392, abs=0.002)
    assert np.corrcoef(one.ravel(), two.ravel())[0, 1] == pytest.approx(0, abs=0.01)
    assert np.corrcoef(one[:, 1:].ravel(), one[:, :-1].ravel())[0, 1] == pytest.approx(0, abs=0.01)


def test_flicker_changes_the_whole_frame_from_one_to_the_next():
    camera = OutdoorCamera(Disturbance(0.0, 0.0, 0.03), 2)
    levels = [camera.capture(np.full((40, 40, 3), 100, np.float32), index) for index in range(100)]
    assert all(level.min() == level.max() for level in levels)
    assert np.std([level[0, 0, 0] for level in levels]) == pytest.approx(3, rel=0.25)


def test_a_cloud_dims_and_tints_and_leaves_warmer_light():
    cloud = Cloud(start=10, length=50, dimming=0.4)
    assert cloud(0) == (1, 1, 1)
    red, green, blue = cloud(35)
    assert green == pytest.approx(0.6)
    assert red < green < blue
    red, green, blue = cloud(80)
    assert green == 1
    assert red > green > blue
    frame = CloudyCamera(CALM, 0, cloud).capture(np.full((40, 40, 3), 100, np.float32), 35)
    assert frame[0, 0, 1] == 60


@pytest.mark.parametrize("name", ["clear", "turn", "scale"])
def test_truth_moves_with_the_shake(name):
    """Centre of mass of the target against the empty stage, by a shaking and by a calm camera."""
    made = make_scene(name, seed=3)
    target = made.actors[made.target]
    away = replace(target, path=lambda _: Box(-500, -500, 9, 9))
    shaky, calm = OutdoorCamera(SHAKY, 3), OutdoorCamera(CALM, 3)
    shots = {
        (actor is target, camera is shaky): list(
            replace(made, actors=(actor,), target=0, camera=camera).frames(range(0, 24, 3))
        )
        for actor in (target, away)
        for camera in (shaky, calm)
    }
    for number in range(8):
        moved, still = (
            centre_of_mass(shots[True, kind][number], shots[False, kind][number])
            for kind in (True, False)
        )
        box, steady = (shots[True, kind][number].truth.box for kind in (True, False))
        assert np.abs(still - steady.centre).max() < 4
        np.testing.assert_allclose(
            np.subtract(box.centre, steady.centre),
            np.subtract(SHAKE_MARGIN, shaky.offset(3 * number)),
        )
        np.testing.assert_allclose(moved - still, np.subtract(box.centre, steady.centre), atol=0.3)


def centre_of_mass(shot, empty):
    light = np.abs(shot.frame.astype(float) - empty.frame).sum(axis=2)
    light[light < 9] = 0
    rows, columns = np.indices(light.shape) + 0.5
    return np.array([(light * columns).sum(), (light * rows).sum()]) / light.sum()
