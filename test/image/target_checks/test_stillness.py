# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Targets that stay where they are, and what else moves meanwhile."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.target_checks.stillness import (
    STILLNESS_PATIENCE,
    STILLNESS_SENTENCE,
    Stillness,
)

RATE = 10
TARGET = Box(200.0, 100.0, 40.0, 30.0)
GROUND = np.random.default_rng(1).integers(40, 160, (30, 40, 3), np.uint8).repeat(8, 0).repeat(8, 1)


def street(seconds, others=True, pan=0.0):
    """Frame of a noisy camera with a vehicle that drives through in ten seconds."""
    frame = np.roll(GROUND, round(pan * seconds), axis=1)
    frame += np.random.default_rng(round(10 * seconds)).integers(0, 20, frame.shape, np.uint8)
    if others:
        frame[180:200, int(28 * seconds) : int(28 * seconds) + 30] = 250
    return frame


def watch(seconds, box_at, **options):
    """Return for each image whether the target is suspect, and all that is said."""
    still, suspect, said = Stillness(), [], []
    still.begin(TARGET, 0)
    for index in range(int(seconds * RATE)):
        frame = street(index / RATE, **options)
        said += still.look(frame, box_at(index / RATE), index * 10**9 // RATE)
        suspect.append(still.is_suspect)
    return suspect, said


def shifted(way, growth=1.0):
    return Box.around(
        (TARGET.centre[0] + way, TARGET.centre[1]), TARGET.width * growth, TARGET.height * growth
    )


def test_a_target_that_stays_while_others_drive_is_suspect_after_some_seconds():
    suspect, said = watch(8, lambda seconds: shifted(np.sin(seconds)))
    assert suspect.index(True) == STILLNESS_PATIENCE * RATE
    assert all(suspect[suspect.index(True) :])
    assert said == [STILLNESS_SENTENCE]


def test_where_nothing_else_moves_nothing_is_suspected():
    suspect, said = watch(8, lambda seconds: TARGET, others=False)
    assert not any(suspect) and not said


def test_a_vehicle_that_the_camera_goes_with_is_not_suspect():
    assert not any(watch(8, lambda seconds: TARGET, pan=40.0)[0])


def test_light_that_is_switched_is_no_other_thing():
    still = Stillness()
    still.begin(TARGET, 0)
    for index in range(8 * RATE):
        frame = street(0.0, others=False) // (1 + index // 10 % 2)
        still.look(frame, TARGET, index * 10**9 // RATE)
    assert not still.is_suspect


def test_the_target_s_own_movement_is_no_other_s():
    still = Stillness()
    still.begin(TARGET, 0)
    for index in range(8 * RATE):
        frame = street(0.0, others=False)
        frame[100:130, 200:240] = 20 + 12 * (index // 5)
        still.look(frame, TARGET, index * 10**9 // RATE)
    assert not still.is_suspect


@pytest.mark.parametrize("speed", [10.0, -30.0])
def test_a_car_that_parks_after_it_drove_is_never_suspect(speed):
    assert not any(watch(20, lambda seconds: shifted(speed * min(seconds, 4.0)))[0])


def test_a_car_that_parks_where_it_began_is_not_suspect():
    assert not any(watch(20, lambda seconds: shifted(30 * max(2 - abs(seconds - 2), 0)))[0])


@pytest.mark.parametrize("growth", [0.1, -0.06])
def test_a_car_that_comes_straight_on_is_not_suspect(growth):
    assert not any(watch(8, lambda seconds: shifted(0.0, 1 + growth * seconds))[0])


def test_a_car_that_sets_off_late_is_suspect_no_more():
    suspect, said = watch(12, lambda seconds: shifted(20.0 * max(seconds - 6.0, 0.0)))
    assert any(suspect) and not suspect[-1] and len(said) == 1


def test_a_new_target_begins_anew():
    still = Stillness()
    still.begin(TARGET, 0)
    for index in range(8 * RATE):
        still.look(street(index / RATE), TARGET, index * 10**9 // RATE)
    assert still.is_suspect
    still.begin(TARGET, 8 * 10**9)
    assert not still.is_suspect
    assert still.look(street(8.1), TARGET, 81 * 10**8) == []


@pytest.mark.parametrize("box", [(-30.0, -20.0, 40.0, 30.0), (300.0, 220.0, 60.0, 60.0)])
def test_a_target_at_the_border_is_judged_too(box):
    still, said = Stillness(), []
    still.begin(Box(*box), 0)
    for index in range(8 * RATE):
        said += still.look(street(index / RATE), Box(*box), index * 10**9 // RATE)
    assert said == [STILLNESS_SENTENCE]
