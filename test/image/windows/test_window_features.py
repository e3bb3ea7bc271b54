# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What every window feature keeps to."""

import numpy as np
import pytest
from feature_samples import FEATURES
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.image.windows.similarity import Reference, bhattacharyya_coefficient
from vehicle_pf_tracker.image.windows.window import Window

every_feature = pytest.mark.parametrize("feature", FEATURES.values(), ids=list(FEATURES))


def noise(seed, size, levels=256):
    values = np.random.default_rng(seed).integers(0, levels, (*size, 3))
    return (values * (255 // max(levels - 1, 1))).astype(np.uint8)


@every_feature
@settings(max_examples=25)
@given(
    seed=st.integers(0, 2**32 - 1),
    size=st.tuples(st.integers(1, 30), st.integers(1, 40)),
    half=st.tuples(st.integers(0, 12), st.integers(0, 9)),
    levels=st.sampled_from([1, 2, 256]),
)
def test_many_windows_at_once_agree_with_one_after_the_other(feature, seed, size, half, levels):
    frame, window = noise(seed, size, levels), Window(*half)
    positions = np.random.default_rng(seed).uniform(-5, 45, (9, 2))
    together = feature.histograms(frame, positions, window)
    alone = [feature.histograms(frame, position[np.newaxis], window)[0] for position in positions]
    assert together == pytest.approx(np.array(alone), abs=1e-12)
    sums = together.sum(axis=1)
    assert np.all((np.abs(sums - 1) < 1e-9) | (sums == 0))
    reference = together[0]
    expected = bhattacharyya_coefficient(together, reference)
    assert feature.similarity(frame, positions, window, Reference(reference)) == pytest.approx(
        expected, abs=1e-9
    )


@every_feature
def test_a_window_is_most_alike_to_itself(feature):
    frame, window = noise(1, (60, 80)), Window(12, 9)
    positions = np.random.default_rng(2).uniform(10, 50, (30, 2))
    reference = feature.histograms(frame, positions[4:5], window)[0]
    similarity = feature.similarity(frame, positions, window, Reference(reference))
    assert similarity[4] == pytest.approx(1.0)
    assert similarity.argmax() == 4


@every_feature
@pytest.mark.parametrize("view", ["mirrored", "channels swapped", "cropped"])
def test_strided_views_give_what_their_copies_give(feature, view):
    whole = noise(4, (40, 50))
    frame = {
        "mirrored": whole[:, ::-1],
        "channels swapped": whole[..., ::-1],
        "cropped": whole[3:30, 5:45],
    }[view]
    frame.flags.writeable = False
    positions = np.random.default_rng(5).uniform(0, 30, (9, 2))
    assert np.array_equal(
        feature.histograms(frame, positions, Window(5, 4)),
        feature.histograms(frame.copy(), positions, Window(5, 4)),
    )


@every_feature
def test_only_the_pixels_around_the_windows_count(feature):
    frame = noise(6, (60, 60))
    other = noise(7, (60, 60))
    other[19:42, 19:42] = frame[19:42, 19:42]
    positions = np.array([[28.5, 27.5], [32.5, 33.5]])
    window = Window(8, 7)
    assert np.array_equal(
        feature.histograms(frame, positions, window), feature.histograms(other, positions, window)
    )
