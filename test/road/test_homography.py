# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.homography import Homography, fit_homography

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])


def test_a_square_of_10_px_to_the_metre():
    found = fit_homography(SQUARE, SQUARE / 10)
    assert found.to_road(np.array([50.0, 30.0])) == pytest.approx([5.0, 3.0])
    assert found.to_image(np.array([5.0, 3.0])) == pytest.approx([50.0, 30.0])
    assert found.jacobian(np.array([20.0, 70.0])) == pytest.approx(np.eye(2) / 10)


def test_a_trapezium_by_hand():
    # x = u / (1 - v / 200), y = v / (1 - v / 200): the horizon is at v = 200, and half way up to
    # it everything is half as large.
    pixels = np.array([[0.0, 0.0], [100.0, 0.0], [0.0, 100.0], [50.0, 100.0]])
    metres = np.array([[0.0, 0.0], [100.0, 0.0], [0.0, 200.0], [100.0, 200.0]])
    found = fit_homography(pixels, metres)
    assert found.to_road(np.array([25.0, 50.0])) == pytest.approx([25 / 0.75, 50 / 0.75])
    near = found.nearness(np.array([[0.0, 0.0], [0.0, 100.0], [77.0, 200.0]]))
    assert near / near[0] == pytest.approx([1.0, 0.5, 0.0], abs=1e-9)
    # dx/du = 1 / (1 - v/200), dy/dv = 1 / (1 - v/200)^2
    assert found.jacobian(np.array([0.0, 100.0])) == pytest.approx(np.diag([2.0, 4.0]))


def test_jacobian_is_the_derivative():
    found = Homography(np.array([[0.1, 0.01, 2.0], [0.02, 0.3, 1.0], [1e-4, 2e-3, 0.5]]))
    point = np.array([120.0, 80.0])
    columns = [
        (found.to_road(point + step) - found.to_road(point - step)) / 2e-3
        for step in np.eye(2) * 1e-3
    ]
    assert found.jacobian(point) == pytest.approx(np.column_stack(columns), rel=1e-6)


def test_more_pairs_give_the_least_squares_in_the_image():
    rng = np.random.default_rng(3)
    true = Homography(np.array([[0.05, 0.0, -16.0], [0.0, -0.02, 10.0], [0.0, 0.002, -0.2]]))
    pixels = rng.uniform((0, 150), (640, 480), (12, 2))
    metres = true.to_road(pixels)
    read = pixels + rng.normal(size=pixels.shape)

    def cost(matrix):
        return np.sum((Homography(matrix).to_image(metres) - read) ** 2)

    found = fit_homography(read, metres).matrix
    least = cost(found)
    assert least < cost(true.matrix)
    for index in np.ndindex(3, 3):
        for factor in (0.999, 1.001):
            other = found.copy()
            other[index] *= factor
            assert cost(other) >= least * (1 - 1e-9)


@pytest.mark.parametrize(
    ("pixels", "metres", "words"),
    [
        (SQUARE[:3], SQUARE[:3], "at least 4"),
        ([[0, 0], [1, 1], [2, 2], [5, 0]], SQUARE, "no three lie on a line"),
        (SQUARE, [[0, 0], [1, 1], [2, 2], [5, 0]], "no three lie on a line"),
        ([[0, 0], [0, 0], [10, 0], [0, 10]], SQUARE, "no three lie on a line"),
        ([[0, 0], [1, 1], [2, 2], [3, 3], [4, 4]], [*SQUARE, [5, 5]], "no three lie"),
        ([[7, 7]] * 4, SQUARE, "^the pairs of the road are all the same point, or not finite$"),
        (SQUARE, SQUARE[[0, 1, 3, 2]], "both sides of its horizon"),
    ],
)
def test_pairs_that_do_not_determine_the_road_are_refused(pixels, metres, words):
    with pytest.raises(InputError, match=words):
        fit_homography(np.asarray(pixels, float), np.asarray(metres, float))


@pytest.mark.parametrize("seed", range(20))
def test_rounding_does_not_save_three_points_on_a_line(seed):
    line = np.array([[0.0, 0.0], [200.0, 200.0], [400.0, 400.0], [400.0, 0.0]])
    read = line + np.random.default_rng(seed).uniform(-0.5, 0.5, (4, 2))
    with pytest.raises(InputError, match="no three lie on a line"):
        fit_homography(read, SQUARE)


def test_a_long_narrow_lane_is_enough():
    # 3.5 m x 200 m from 5 m above it, 0.1 rad down, 800 px of focal length.
    metres = np.array([[0.0, 12.0], [3.5, 12.0], [3.5, 200.0], [0.0, 200.0]])
    depth = 5 * np.sin(0.1) + metres[:, 1] * np.cos(0.1)
    below = 5 * np.cos(0.1) - metres[:, 1] * np.sin(0.1)
    pixels = 800 * np.column_stack([metres[:, 0], below]) / depth[:, np.newaxis]
    found = fit_homography(pixels, metres)
    assert found.to_road(pixels) == pytest.approx(metres, abs=1e-6)


@pytest.mark.filterwarnings("error")
def test_a_pixel_on_the_horizon_is_not_finite_and_no_warning():
    found = Homography(np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -0.25, 1.0]]))
    assert not np.isfinite(found.to_road(np.array([3.0, 4.0]))).any()
