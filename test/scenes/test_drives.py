# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every scene of a drive, over seeds: occlusions it promises, room to recover, target in sight."""

import functools
from itertools import pairwise

import pytest
from drive_checks import check_room_to_recover, check_target, phases

from laboratory.scenes import LABORATORY_SCENES, make_scene
from vehicle_pf_tracker.core.truth import Occlusion

NONE, PARTIAL, TOTAL = Occlusion.NONE, Occlusion.PARTIAL, Occlusion.TOTAL
SEEDS = [0, pytest.param(1, marks=pytest.mark.slow)]
DRIVES = sorted(set(LABORATORY_SCENES) - {"bar", "highway", "road"})

TOTALS = {
    "bars": [(4, 9), (10, 15)],
    "bridge": [(14, 20)],
    "bus": [(13, 19)],
    "cross": [(10, 20)],
    "braking": [(15, 23)],
    "turn_occluded": [(20, 32)],
}
"""Fewest and most frames of each total occlusion, by scene; the others have none."""
PARTIALS = ["trees", "dense"]
CLEAR = ["clear", "acceleration", "turn", "scale", "twin", "shadows", "illumination"]


def truths_of(name, seed, **settings):
    return _truths(name, seed, tuple(settings.items()))


@functools.cache
def _truths(name, seed, settings):
    return list(make_scene(name, seed=seed, settings=dict(settings)).truths())


@pytest.mark.parametrize("name", TOTALS)
@pytest.mark.parametrize("seed", SEEDS)
def test_total_occlusions_come_as_often_and_last_as_long_as_said(name, seed):
    lengths = [length for state, length in phases(truths_of(name, seed)) if state is TOTAL]
    assert len(lengths) == len(TOTALS[name])
    for length, (fewest, most) in zip(lengths, TOTALS[name], strict=True):
        assert fewest <= length <= most


@pytest.mark.parametrize("name", PARTIALS)
@pytest.mark.parametrize("seed", SEEDS)
def test_partial_occlusions_hide_a_good_part_and_never_all(name, seed):
    least = min(truth.visible_fraction for truth in truths_of(name, seed))
    assert 0.15 < least < 0.85


@pytest.mark.parametrize("name", CLEAR)
@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_hides_the_target_where_nothing_is_in_the_way(name, seed):
    assert {truth.visible_fraction for truth in truths_of(name, seed)} == {1.0}


@pytest.mark.parametrize("name", DRIVES)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_drive_has_room_to_recover_inside_its_image(name, seed):
    check_room_to_recover(truths_of(name, seed))
    check_target(make_scene(name, seed=seed), truths_of(name, seed))


def test_every_scene_is_judged_here():
    assert {*TOTALS, *PARTIALS, *CLEAR} == set(DRIVES)


@pytest.mark.parametrize("name", ["bridge", "turn_occluded", "scale", "cross"])
def test_the_other_heading_is_as_good(name):
    right, left = (phases(truths_of(name, 2, heading=heading)) for heading in ("right", "left"))
    assert [state for state, _ in right] == [state for state, _ in left]


@pytest.mark.parametrize("kind", ["suv", "truck"])
def test_any_vehicle_is_hidden_by_the_bridge(kind):
    assert TOTAL in {truth.occlusion for truth in truths_of("bridge", 0, vehicle=kind)}


@pytest.mark.parametrize("speed", [3.0, 8.0, 15.0])
def test_speed_is_in_px_per_frame(speed):
    truths = truths_of("clear", 5, speed=speed)
    travelled = truths[-1].box.centre[0] - truths[0].box.centre[0]
    # The driver sways by up to 1.5 px at either end.
    assert travelled == pytest.approx(speed * (len(truths) - 1), abs=3)


def test_speeds_of_braking_and_acceleration():
    def steps(truths):
        return [b.box.x - a.box.x for a, b in pairwise(truths)]

    braking = steps(truths_of("braking", 1))
    assert braking[0] == pytest.approx(5, abs=0.15)
    assert braking[-1] == pytest.approx(3, abs=0.15)
    faster = steps(truths_of("acceleration", 1))
    assert max(faster) == pytest.approx(11, abs=0.15)
    assert faster[-1] == pytest.approx(5, abs=0.15)


def test_size_changes_by_the_factor():
    for way, first in (("away", 2.5), ("towards", 1 / 2.5)):
        truths = truths_of("scale", 0, way=way)
        ratio = truths[0].box.width / truths[-1].box.width
        assert ratio == pytest.approx(first, rel=0.03)


def test_a_turn_ends_in_the_narrow_view_from_behind():
    boxes = [truth.box for truth in truths_of("turn", 0)]
    assert boxes[0].width > 1.5 * boxes[0].height
    assert boxes[-1].width < boxes[-1].height
    assert boxes[-1].y < boxes[0].y - 100
