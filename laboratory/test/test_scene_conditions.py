# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Weather, light and transmission in which a scene is seen."""

import cv2
import numpy as np
import pytest

from laboratory.scenes import make_traffic_scene
from laboratory.scenes.conditions import CONDITIONS
from laboratory.scenes.mot_folder import write_mot_folder
from laboratory.scenes.traffic_scene import VehicleTruth
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence

SIZE = (160, 120)
FRAME = np.random.default_rng(0).integers(90, 130, (120, 160, 3)).astype(np.uint8)


def vehicle(x, y):
    box = Box(x, y, 30.0, 24.0)
    return VehicleTruth(1, box, box, 1.0)


def seen(name, index, frame=FRAME, truth=(), after=(), seed=0):
    return CONDITIONS[name](SIZE, seed)(frame, index, truth, after)


@pytest.mark.parametrize("name", CONDITIONS)
def test_frames_are_the_same_in_any_order_and_the_original_is_kept(name):
    before = FRAME.copy()
    condition = CONDITIONS[name](SIZE, 3)
    first = [condition(FRAME, index, (), ()) for index in (4, 9)]
    again = [seen(name, index, seed=3) for index in (9, 4)]
    assert np.array_equal(first[0], again[1])
    assert np.array_equal(first[1], again[0])
    assert np.array_equal(FRAME, before)
    assert first[0].dtype == np.uint8


@pytest.mark.parametrize("name", ["snow", "rain", "foliage"])
def test_weather_and_leaves_move(name):
    changed = np.abs(seen(name, 10).astype(int) - seen(name, 12)).sum(axis=2) > 40
    assert changed.mean() > 0.005


def test_leaves_are_in_their_corner_alone():
    image = seen("foliage", 20)
    assert np.array_equal(image[40:], FRAME[40:])
    assert np.array_equal(image[:, 70:], FRAME[:, 70:])
    assert (image[:20, :30] != FRAME[:20, :30]).any()


def test_head_lights_shine_before_a_vehicle_that_comes():
    coming, going = (
        seen("dusk", 0, truth=[vehicle(60, 40)], after=[vehicle(60, 40 + way)]) for way in (4, -4)
    )
    dark = seen("dusk", 0)
    assert dark.mean() < 0.35 * FRAME.mean()
    road = (slice(68, 80), slice(65, 85))  # below the box
    assert coming[road].mean() > dark[road].mean() + 40
    assert abs(going[road].mean() - dark[road].mean()) < 3
    assert coming[40:64, 60:90].max() > 200  # its lamps
    assert going[50:64, 60:90].max() < 120


def test_a_beam_outside_of_the_image_is_cut_off():
    image = seen("dusk", 0, truth=[vehicle(-20, 110)], after=[vehicle(-24, 118)])
    assert image.shape == FRAME.shape


def test_few_bits_leave_blocks():
    image = seen("compression", 0)
    assert 3 < np.abs(image.astype(int) - FRAME).mean() < 30


def test_a_stream_keeps_red_apart_from_blue():
    """OpenCV writes blue first: a red vehicle is coded as red."""
    red = np.zeros_like(FRAME)
    red[..., 0] = FRAME[..., 0]
    received = seen("compression", 0, red)
    as_sent = cv2.imencode(".jpg", red[..., ::-1], (cv2.IMWRITE_JPEG_QUALITY, 10))[1]
    assert np.array_equal(received, cv2.imdecode(as_sent, cv2.IMREAD_COLOR)[..., ::-1])


def test_every_other_frame_is_kept_at_half_the_rate(tmp_path):
    scene = make_traffic_scene("traffic-pair", settings=["frames=5"])
    write_mot_folder(scene, tmp_path / "all", 0)
    write_mot_folder(scene, tmp_path / "half", 0, every=2)
    whole, half = (read_sequence(tmp_path / name) for name in ("all", "half"))
    assert (half.frame_count, half.frame_rate) == (3, whole.frame_rate / 2)
    kept = whole.truth[whole.truth[:, 0] % 2 == 1, 1:]
    assert np.array_equal(half.truth[:, 1:], kept)
    assert np.array_equal(list(half.frames())[2], list(whole.frames())[4])
