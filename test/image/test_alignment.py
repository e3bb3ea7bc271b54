"""Alignment to fractions of a pixel."""

import math

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.image.alignment import Alignment

SIDE = 31
LOOSE = 1e3


def scene():
    """A smooth texture that is much larger than the template."""
    rough = np.random.default_rng(4).normal(120, 60, (121, 121)).astype(np.float32)
    return cv2.GaussianBlur(rough, (0, 0), 2.5)


def cut(image, x, y, scale):
    """Patch around the middle plus (x, y), `scale` times as large."""
    half, middle = (SIDE - 1) / 2, 60.0
    matrix = np.array(
        [[scale, 0, middle + x - scale * half], [0, scale, middle + y - scale * half]]
    )
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return cv2.warpAffine(image, matrix, (SIDE, SIDE), flags=flags)


def aligned(change=lambda patch: patch, sigma=LOOSE, start=(1.3, -0.8, 1.04)):
    """Where steps lead from a start beside the truth (0, 0, 1)."""
    image = scene()
    alignment = Alignment(cut(image, 0.0, 0.0, 1.0))
    x, y, scale = start
    for _ in range(8):
        step = alignment.step(change(cut(image, x, y, scale)), math.log(scale), sigma)
        x, y = x + scale * step.place[0], y + scale * step.place[1]
        scale *= math.exp(step.log_scale)
    return x, y, scale, step.coefficient


def test_place_and_scale_are_found_between_pixels():
    x, y, scale, coefficient = aligned()
    assert (x, y) == pytest.approx((0, 0), abs=0.05)
    assert scale == pytest.approx(1.0, abs=0.005)
    assert coefficient > 0.99


def test_light_takes_no_part():
    x, y, scale, coefficient = aligned(lambda patch: 0.5 * patch + 40)
    assert (x, y) == pytest.approx((0, 0), abs=0.05)
    assert scale == pytest.approx(1.0, abs=0.005)
    assert coefficient > 0.99


def test_a_covered_corner_is_borne_where_the_scale_is_expected():
    def covered(patch):
        patch = patch.copy()
        patch[:8, :8] = 160
        return patch

    x, y, scale, coefficient = aligned(covered, sigma=0.02)
    assert (x, y) == pytest.approx((0, 0), abs=0.5)
    assert scale == pytest.approx(1.0, abs=0.03)
    assert coefficient < 0.95


def test_the_scale_keeps_to_what_is_expected_as_far_as_that_is_sure():
    image = scene()
    alignment = Alignment(cut(image, 0.0, 0.0, 1.0))
    larger = cut(image, 0.0, 0.0, 1.05)
    loose = alignment.step(larger, 0.0, LOOSE).log_scale
    sure = alignment.step(larger, 0.0, 1e-4).log_scale
    assert loose == pytest.approx(-math.log(1.05), abs=0.01)
    assert abs(sure) < 0.1 * abs(loose)


def test_no_structure_moves_nothing():
    flat = np.full((SIDE, SIDE), 90, np.float32)
    step = Alignment(flat).step(flat, 0.0, 0.02)
    assert step.place == pytest.approx((0, 0))
    assert step.log_scale == pytest.approx(0)
    assert step.coefficient == pytest.approx(0, abs=0.01)  # rounding over next to no energy
