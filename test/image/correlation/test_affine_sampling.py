# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A large piece is sampled by way of four channels, to the values of three."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.correlation.affine_sampling import Axis, sampled


def noise(height: int, width: int) -> Frame:
    return np.random.default_rng(3).integers(0, 256, (height, width, 3)).astype(np.uint8)


def three_channels(frame: Frame, x: Axis, y: Axis, size: tuple[int, int]) -> Frame:
    matrix = np.array([[x[0], 0, x[1]], [0, y[0], y[1]]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    image = cv2.warpAffine(frame, matrix, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(image, np.uint8)


@pytest.mark.parametrize("size", [(128, 128), (96, 64), (56, 40), (8, 8)])
@pytest.mark.parametrize(
    "shift", [(40.3, 70.9), (-30.7, 150.2), (260.5, -90.1), (-500.0, 20.0), (20.0, 900.0)]
)
@pytest.mark.parametrize("scale", [(0.31, 0.78), (1.0, 1.0), (1.62, 1.13)])
def test_values_are_those_of_three_channels(
    size: tuple[int, int], shift: Axis, scale: Axis
) -> None:
    x, y = zip(scale, shift, strict=True)
    frame = noise(240, 320)
    np.testing.assert_array_equal(sampled(frame, x, y, size), three_channels(frame, x, y, size))


def test_frames_of_other_sizes_by_turns_and_views() -> None:
    x, y = (0.9, 10.3), (0.8, -4.6)
    for frame in (noise(90, 160), noise(120, 60)[:, ::-1], noise(90, 160)[..., ::-1], noise(1, 1)):
        expected = three_channels(np.ascontiguousarray(frame), x, y, (80, 80))
        np.testing.assert_array_equal(sampled(frame, x, y, (80, 80)), expected)
