# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The clear level of a similarity: level, deviation and hysteresis by hand."""

import pytest

from vehicle_pf_tracker.trackers.papers.clear_level import ClearLevel, ClearLevelParameters

SETTINGS = ClearLevelParameters(enter=4.0, leave=2.0, rate=0.5)


def level_of(*similarities):
    level = ClearLevel()
    for similarity in similarities:
        level.add(similarity, SETTINGS.rate)
    return level


def test_the_first_clear_similarity_becomes_the_level():
    level = ClearLevel()
    level.judge(0.7, SETTINGS)
    assert level.clear
    level.add(0.7, SETTINGS.rate)
    assert level.value == pytest.approx(0.7)
    assert level.deviation == pytest.approx(0.05)


def test_before_the_first_clear_frame_a_small_share_of_one_is_an_occlusion():
    level = ClearLevel()  # Pi_0 = 1, certain 0.65
    for similarity, clear in ((0.64, False), (0.3, False), (0.65, True)):
        level.judge(similarity, SETTINGS)
        assert level.clear is clear


def test_a_slow_fall_does_not_widen_its_own_bound():
    settings, level = ClearLevelParameters(), level_of(*[0.85, 0.87] * 30)
    similarity, frames = 0.85, 0
    while level.clear and frames < 40:
        similarity, frames = similarity - 0.02, frames + 1
        level.judge(similarity, settings)
        if level.clear:
            level.add(similarity, settings.rate)
    assert not level.clear
    assert similarity > 0.6


def test_it_is_left_and_entered_again_at_different_depths():
    level = level_of(0.8)  # deviation 0.05: left below 0.6, entered again at 0.7
    for similarity, clear in ((0.61, True), (0.59, False), (0.69, False), (0.71, True)):
        level.judge(similarity, SETTINGS)
        assert level.clear is clear


def test_a_level_that_never_varied_still_bears_noise():
    level = level_of(*[0.8] * 60)
    level.judge(0.8 - 4 * 0.005 + 1e-9, SETTINGS)
    assert level.clear
    level.judge(0.8 - 4 * 0.005 - 1e-6, SETTINGS)
    assert not level.clear


def test_a_fall_to_a_small_share_is_one_whatever_the_deviation():
    wide = ClearLevelParameters(enter=100.0, leave=100.0, rate=0.5, certain=0.65)
    level = level_of(0.8)
    for similarity, clear in ((0.53, True), (0.51, False), (0.53, True)):
        level.judge(similarity, wide)
        assert level.clear is clear


def test_judging_does_not_count():
    level = level_of(0.8, 0.7)
    before = level.value, level.deviation
    level.judge(0.1, SETTINGS)
    assert (level.value, level.deviation) == before
