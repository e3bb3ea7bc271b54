# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every scene after the papers, over seeds: the occlusions of its row, and room to recover."""

import functools
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from drive_checks import check_room_to_recover, check_target, phases

from reproduction.scenes.paper_scenes import FIXED_SCENES, VIDEO_SCENES, make_scene
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion

NONE, PARTIAL, TOTAL = Occlusion.NONE, Occlusion.PARTIAL, Occlusion.TOTAL
SEEDS = [0, pytest.param(1, marks=pytest.mark.slow)]


@functools.cache
def truths_of(name, seed):
    return list(make_scene(name, seed=seed).truths())


def occluded_by_itself(runs):
    """Test whether there is a partial occlusion that neither begins nor ends a total one."""
    states = [state for state, _ in runs]
    return any(
        state is PARTIAL and TOTAL not in (*states[i - 1 : i], *states[i + 1 : i + 2])
        for i, state in enumerate(states)
    )


@pytest.mark.parametrize("name", FIXED_SCENES)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_scene_has_room_to_recover_inside_its_image(name, seed):
    if name != "disturbances":  # features are measured at the true position: nothing recovers
        check_room_to_recover(truths_of(name, seed))
    check_target(make_scene(name, seed=seed), truths_of(name, seed))


@pytest.mark.parametrize("name", FIXED_SCENES)
@pytest.mark.parametrize("seed", SEEDS)
def test_scenes_have_the_occlusions_of_their_row(name, seed):
    runs = phases(truths_of(name, seed))
    states = {state for state, _ in runs}
    promised = FIXED_SCENES[name].occlusion
    assert (TOTAL in states) == ("total" in promised)
    assert occluded_by_itself(runs) == ("partial" in promised)
    if name in VIDEO_SCENES:
        assert (states == {NONE}) == (promised == "none")


def test_videos_follow_table_i():
    """Vehicle and resolution of the paper's rows."""
    rows = [video.parameters for video in VIDEO_SCENES.values()]
    kinds = ["suv", "car", "suv", "car", *3 * ["truck"], *3 * ["car"], "truck", *9 * ["car"]]
    assert [row.vehicle for row in rows] == kinds
    assert {row.resolution for row in rows[11:18]} == {"768x576"}
    assert {row.resolution for row in rows[:11] + rows[18:]} == {"640x480"}
    assert list(VIDEO_SCENES) == [f"video{number:02d}" for number in range(1, 21)]


@pytest.mark.parametrize("seed", SEEDS)
def test_cases_four_and_five_and_the_phases_last_as_long_as_in_the_papers(seed):
    four, five = (
        [length for state, length in phases(truths_of(name, seed)) if state is TOTAL]
        for name in ("case4", "case5")
    )
    assert four == [pytest.approx(70, abs=3)]
    assert len(five) == 2
    assert max(five) <= 10
    states, lengths = zip(*phases(truths_of("phases", seed)), strict=True)
    assert states == (NONE, PARTIAL, TOTAL, PARTIAL, NONE)
    assert lengths[:3] == pytest.approx((40, 30, 20), abs=2)
    assert lengths[4] >= 40


@pytest.mark.parametrize("seed", SEEDS)
def test_case_six_turns_out_of_sight(seed):
    hidden = [t.box for t in truths_of("case6", seed) if t.visible_fraction < 1]
    assert hidden[0].width > 1.5 * hidden[0].height
    assert hidden[-1].width < hidden[-1].height


def some(name, count=2, **options):
    return list(islice(make_scene(name, **options).frames(), count))


@pytest.mark.parametrize("name", FIXED_SCENES)
def test_a_seed_decides_every_bit_and_frames_have_the_scene_s_truths(name):
    scene = make_scene(name, seed=7)
    shown, truths = some(name, seed=7), list(scene.truths())
    for one, two in zip(shown, islice(scene.frames(), 2), strict=True):
        np.testing.assert_array_equal(one.frame, two.frame)
        assert one.truth == two.truth
    assert [shot.truth for shot in shown] == truths[:2]
    assert len(truths) == scene.frame_count
    other = some(name, 1, seed=8)[0]  # which changes more than the noise
    assert np.abs(shown[0].frame.astype(int) - other.frame).mean() > 2.5


def test_nothing_but_the_seed_can_be_chosen():
    with pytest.raises(InputError, match="scene video01 has no setting 'speed'; it has none"):
        make_scene("video01", settings={"speed": 3})


def test_the_notes_name_every_scene():
    notes = Path(__file__).parents[2] / "laboratory" / "notes"
    page = (notes / "paper_scenes.md").read_text(encoding="utf-8")
    for name in FIXED_SCENES:
        assert f"`{name}`" in page, name


@pytest.mark.slow
def test_scenes_of_one_table_show_different_vehicles():
    names = list(VIDEO_SCENES)
    colours = {
        tuple((_window(some(name, 1)[0]) // 32).tolist()) for name in names[:4] + names[7:12]
    }
    assert len(colours) > 4


def _window(shot):
    x, y = (round(value) for value in shot.truth.box.centre)
    return np.median(shot.frame[y - 6 : y + 6, x - 12 : x + 12], axis=(0, 1)).astype(int)
