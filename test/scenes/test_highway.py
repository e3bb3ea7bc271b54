# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The highway: two total occlusions for every seed, and what the README's animation relies on."""

from itertools import groupby

import numpy as np
import pytest

from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.scenes.catalogue import make_scene

SEEDS = range(30)
NONE, PARTIAL, TOTAL = Occlusion.NONE, Occlusion.PARTIAL, Occlusion.TOTAL


@pytest.fixture(scope="module")
def truths_by_seed():
    return [list(make_scene("highway", seed=seed).truths()) for seed in SEEDS]


def test_clear_bridge_clear_lorry_clear_for_every_seed(truths_by_seed):
    for truths in truths_by_seed:
        phases = [
            (state, len(list(run))) for state, run in groupby(truth.occlusion for truth in truths)
        ]
        once = [PARTIAL, TOTAL, PARTIAL, NONE]
        assert [state for state, _ in phases] == [NONE, *once, *once]
        lengths = [length for _, length in phases]
        assert lengths[0] >= 25
        assert min(lengths[2], lengths[6]) >= 15
        assert min(lengths[1], lengths[3], lengths[5], lengths[7]) >= 8
        assert lengths[4] >= 15
        assert lengths[8] >= 30


def test_the_demo_scene_stays_as_it_was_fixed_before_any_tuning(truths_by_seed):
    truths = truths_by_seed[0]
    hidden = [index for index, truth in enumerate(truths) if truth.occlusion is TOTAL]
    assert hidden == [*range(47, 69), *range(117, 142)]
    assert truths[0].box.centre == pytest.approx((32.0552, 110.5507), abs=1e-3)
    assert truths[-1].box.centre == pytest.approx((607.6648, 109.2185), abs=1e-3)


def test_target_stays_whole_inside_the_image_at_one_size(truths_by_seed):
    for truths in truths_by_seed:
        boxes = [truth.box for truth in truths]
        assert min(box.x for box in boxes) >= 0
        assert max(box.x + box.width for box in boxes) <= 640
        assert {(round(box.width, 4), round(box.height, 4)) for box in boxes} == {(45.88, 26.2704)}


def test_the_target_looks_like_itself_again_after_each_occlusion():
    """Its window, at the truth, is close to the first one; while hidden it is not."""
    scene = make_scene("highway", seed=4, settings=["noise=0"])
    truths = list(scene.truths())
    hidden = [index for index, truth in enumerate(truths) if truth.occlusion is TOTAL]
    clear = [index for index, truth in enumerate(truths) if truth.occlusion is NONE and index > 90]
    first, *later = map(_window, scene.frames([0, *hidden, *clear]))
    differences = [np.abs(window - first).mean() for window in later]
    assert min(differences[: len(hidden)]) > 25
    assert max(differences[len(hidden) :]) < 25


def _window(shot):
    x, y = (round(value) for value in shot.truth.box.centre)
    return shot.frame[y - 10 : y + 10, x - 18 : x + 18].astype(float)
