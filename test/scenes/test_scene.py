# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A scene made by hand: stamps, truth, painting order, shadows, and the pixels themselves."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.compositing import Sprite
from vehicle_pf_tracker.scenes.courses import moving, standing
from vehicle_pf_tracker.scenes.scene import Actor, Scene

RED, BLUE, BLACK = (Sprite.plain(c) for c in ((200.0, 0, 0), (0, 0, 200.0), (0, 0, 0)))


def scene(*after, before=(), rate=30.0, noise=0.0):
    target = Actor(RED, moving(Box(2, 3, 10, 4), 2.0))
    return Scene(
        40, 12, rate, 8, lambda: np.full((12, 40, 3), 90, np.float32),
        Camera(noise, seed=1), (*before, target, *after), len(before),
    )  # fmt: skip


def test_stamps_start_at_one_second_and_do_not_drift():
    stamps = [truth.stamp_ns for truth in scene().truths()]
    assert stamps[:3] == [1_000_000_000, 1_033_333_333, 1_066_666_667]
    assert stamps[6] == 1_200_000_000


def test_what_is_painted_later_hides_and_what_is_painted_earlier_does_not():
    wall = Actor(BLUE, standing(Box(0, 0, 5, 12)))
    assert scene(wall).truth(0).visible_fraction == pytest.approx(0.7)
    assert scene(wall).truth(0).occlusion is Occlusion.PARTIAL
    assert scene(before=[wall]).truth(0).visible_fraction == 1.0
    np.testing.assert_array_equal(next(scene(wall).frames()).frame[4, 3], (0, 0, 200))
    np.testing.assert_array_equal(next(scene(before=[wall]).frames()).frame[4, 3], (200, 0, 0))


def test_a_shadow_darkens_and_does_not_hide():
    shade = Actor(Sprite.plain((0.0, 0.0, 0.0), 0.5), standing(Box(0, 0, 40, 12)), hides=False)
    first = next(scene(shade).frames())
    assert first.truth.occlusion is Occlusion.NONE
    np.testing.assert_array_equal(first.frame[4, 3], (100, 0, 0))


def test_a_tenth_visible_is_partial_and_less_is_total():
    def seen(width):
        return scene(Actor(BLACK, standing(Box(0, 0, 2 + width, 12)))).truth(0).occlusion

    assert [seen(width) for width in (8.9, 9.1, 12)] == [
        Occlusion.PARTIAL,
        Occlusion.TOTAL,
        Occlusion.TOTAL,
    ]


def test_noise_has_its_standard_deviation_and_each_frame_its_own():
    one, two = (f.frame[8:].astype(float) for f in list(scene(noise=5.0).frames())[:2])
    assert one.mean() == pytest.approx(90, abs=1)
    assert one.std() == pytest.approx(5, rel=0.1)
    assert np.corrcoef(one.ravel(), two.ravel())[0, 1] == pytest.approx(0, abs=0.15)


def test_levels_are_clipped_and_rounded_not_wrapped():
    picture = np.array([[[-3.0, 254.6, 300.0]]], np.float32)
    np.testing.assert_array_equal(Camera(0.0, 0).capture(picture, 0), [[[0, 255, 255]]])
