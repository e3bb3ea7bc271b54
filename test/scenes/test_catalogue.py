# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every scene of the catalogue keeps the contract; mistakes are told in one sentence."""

from itertools import islice, pairwise
from pathlib import Path

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import check_frame
from vehicle_pf_tracker.scenes.catalogue import SCENES, make_scene

ALL = sorted(SCENES)
SHORT = 2


def some(name, count=SHORT, **options):
    return list(islice(make_scene(name, **options).frames(), count))


@pytest.mark.parametrize("name", ALL)
def test_the_seed_decides_every_bit_and_frames_have_the_scene_s_truths_and_size(name):
    scene = make_scene(name, seed=7)
    shown, truths = some(name, seed=7), list(scene.truths())
    for one, two in zip(shown, islice(scene.frames(), SHORT), strict=True):
        np.testing.assert_array_equal(one.frame, two.frame)
        assert one.truth == two.truth
        assert check_frame(one.frame).shape == (scene.height, scene.width, 3)
        assert one.frame.flags.c_contiguous
    assert [shot.truth for shot in shown] == truths[:SHORT]
    assert len(truths) == scene.frame_count
    other = some(name, 1, seed=8)[0].frame.astype(int)
    # More than the noise of the sensor alone would make.
    assert np.abs(shown[0].frame - other).mean() > 2.5


@pytest.mark.parametrize("name", ALL)
def test_truth_is_complete_and_plain(name):
    scene = make_scene(name)
    truths = list(scene.truths())
    assert truths[0].stamp_ns == 1_000_000_000
    for before, after in pairwise(truths):
        assert after.stamp_ns - before.stamp_ns == pytest.approx(1e9 / scene.frame_rate, abs=1)
    for truth in truths:
        assert type(truth.visible_fraction) is float
        assert type(truth.box.x) is float
        assert 0 <= truth.visible_fraction <= 1


def test_settings_as_words_and_as_mapping_are_the_same():
    words = make_scene("bar", settings=["speed=8", "width=60"])
    mapping = make_scene("bar", settings={"speed": 8, "width": 60.0})
    assert list(words.truths()) == list(mapping.truths())
    assert words.frame_count < make_scene("bar").frame_count


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        ("motorbike", {}, ["'motorbike'", "bar", "highway"]),
        ("bar", {"settings": ["widht=3"]}, ["'widht'", "bar", "width", "vehicle_width"]),
        ("bar", {"settings": {"widht": 3}}, ["'widht'", "bar", "width", "vehicle_width"]),
        ("clear", {"settings": ["disturbance=wild"]}, ["disturbance", "clean, rough", "'wild'"]),
        ("highway", {"settings": ["width=3"]}, ["'width'", "highway", "noise"]),
        ("bar", {"settings": ["width"]}, ["name=value", "'width'"]),
        ("bar", {"settings": ["width=wide"]}, ["width", "number", "'wide'"]),
        ("bar", {"settings": {"width": "60"}}, ["width", "number", "'60'"]),
        ("bar", {"settings": ["width=500"]}, ["width", "from 0 to 120", "500"]),
        ("bar", {"settings": ["speed=nan"]}, ["speed", "finite"]),
        ("bar", {"seed": -1}, ["seed", "integer >= 0", "-1"]),
    ],
)
def test_mistakes_name_themselves_and_the_remedy(name, options, words):
    with pytest.raises(InputError) as caught:
        make_scene(name, **options)
    sentence = str(caught.value)
    assert "\n" not in sentence
    for word in words:
        assert word in sentence


def test_the_docs_name_every_scene():
    page = (Path(__file__).parents[2] / "docs" / "scenes.md").read_text(encoding="utf-8")
    for name in ALL:
        assert f"`{name}`" in page, name
