# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import cv2
import numpy as np
import pytest
from feature_samples import step_edge
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.image.windows.gradients import (
    GradientDirections,
    direction_bins,
    squared_strength,
)
from vehicle_pf_tracker.image.windows.window import Window, bounds


def directions(frame, window=None, position=(6.5, 4.5), **switches):
    window = window or Window(3, 2)
    feature = GradientDirections(**switches)
    return feature.histograms(frame, np.array([position]), window)[0]


@pytest.mark.parametrize(
    ("gx", "gy", "signed", "folded"),
    [
        (-1, 0, 0, 32),  # 180 degrees is -180
        (0, -1, 16, 48),
        (1, 0, 32, 32),
        (0, 1, 48, 48),
        (1, 1, 40, 40),
        (-1, -1, 8, 40),
        (100, -1, 31, 31),
        (-100, 1, 63, 31),
    ],
)
def test_directions_by_hand(gx, gy, signed, folded):
    gx, gy = np.array([gx]), np.array([gy])
    assert direction_bins(gx, gy, signed=True)[0] == signed
    assert direction_bins(gx, gy, signed=False)[0] == folded


def test_strength_by_hand_and_exact_at_its_largest():
    assert squared_strength(np.array([3]), np.array([-4]))[0] == 25
    assert squared_strength(np.array([1020]), np.array([1019]))[0] == 1020**2 + 1019**2


def test_reading_13_folded_directions_know_no_light_and_dark():
    forward = directions(step_edge(), signed=False)
    backward = directions(step_edge()[:, ::-1], position=(5.5, 4.5), signed=False)
    assert np.array_equal(forward, backward)


def test_reading_14_the_threshold_is_a_share_of_the_strongest():
    # A step of 200 to the right at column 6 and one of 80 back at column 10.
    frame = step_edge(9, 16)
    frame[:, 10:] = 140
    window, position = Window(6, 2), (8.5, 4.5)
    assert directions(frame, window, position, threshold=0.8)[[0, 32]].tolist() == [0, 1]
    assert directions(frame, window, position, threshold=0.3)[[0, 32]].tolist() == [0.5, 0.5]


def test_below_the_floor_nothing_is_an_edge():
    # A step of 9 grey levels makes a gradient of 36, one of 11 makes 44.
    assert not directions(step_edge(dark=100, light=109), floor=40).any()
    assert directions(step_edge(dark=100, light=111), floor=40)[32] == 1.0
    assert directions(step_edge(dark=100, light=109))[32] == 1.0


def test_reading_14_the_window_border_hides_what_the_frame_shows():
    # The window's first column is 6: only the frame shows the step before it.
    window, position = Window(2, 2), (8.5, 4.5)
    assert directions(step_edge(), window, position)[32] == 1.0
    assert not directions(step_edge(), window, position, in_frame=False).any()


def direct(frame, position, window, *, threshold, in_frame, signed, floor):
    """The definition, one window at a time, by OpenCV's own Sobel."""
    left, top, right, bottom = (
        int(side[0]) for side in bounds(frame, np.array([position]), window)
    )
    image = cv2.cvtColor(np.ascontiguousarray(frame), cv2.COLOR_RGB2GRAY)
    inner = (slice(top, bottom), slice(left, right))
    if not in_frame:
        image, inner = image[inner].copy(), (slice(None), slice(None))
    gx = cv2.Sobel(image, cv2.CV_64F, 1, 0)[inner]
    gy = cv2.Sobel(image, cv2.CV_64F, 0, 1)[inner]
    strength = np.hypot(gx, gy)
    limit = max(threshold * strength.max(), floor)
    edges = (strength > 0) & (strength >= limit - 1e-9)
    bins = direction_bins(gx[edges], gy[edges], signed=signed)
    counts = np.bincount(bins, minlength=64)
    return counts / max(counts.sum(), 1)


@settings(max_examples=80)
@given(
    seed=st.integers(0, 2**32 - 1),
    size=st.tuples(st.integers(1, 30), st.integers(1, 40)),
    half=st.tuples(st.integers(0, 12), st.integers(0, 9)),
    threshold=st.sampled_from([0.037, 0.31, 0.83]),
    in_frame=st.booleans(),
    signed=st.booleans(),
    floor=st.sampled_from([0.0, 60.5]),
)
def test_agrees_with_the_definition(seed, size, half, threshold, in_frame, signed, floor):
    rng = np.random.default_rng(seed)
    frame = cv2.GaussianBlur(rng.integers(0, 256, (*size, 3)).astype(np.uint8), (0, 0), 1.5)
    frame = frame.reshape(*size, 3)
    positions = rng.uniform(-5, 45, (9, 2))
    switches = {
        "threshold": threshold, "in_frame": in_frame, "signed": signed, "floor": floor
    }  # fmt: skip
    found = GradientDirections(**switches).histograms(frame, positions, Window(*half))
    expected = [direct(frame, tuple(p), Window(*half), **switches) for p in positions]
    assert found == pytest.approx(np.array(expected), abs=1e-9)
