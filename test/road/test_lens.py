# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.lens import Lens

FOCAL, CENTRE = (800.0, 820.0), (319.5, 239.5)
MODELS = {
    "plumb_bob": (-0.3, 0.12, 0.001, -0.002, -0.02),
    "rational_polynomial": (0.4, 0.05, 0.001, -0.0005, 0.002, 0.7, 0.1, 0.01),
    "equidistant": (0.02, -0.01, 0.003, -0.001),
}
PIXELS = np.array([[320.0, 240.0], [10.5, 20.25], [630.0, 470.0], [5.0, 400.0]])


@pytest.fixture(params=MODELS)
def lens(request):
    return Lens(FOCAL, CENTRE, request.param, MODELS[request.param])


def test_distortion_is_that_of_opencv(lens):
    # OpenCV counts pixels from the centre of the first one, we from its corner.
    matrix = np.array([[FOCAL[0], 0, CENTRE[0]], [0, FOCAL[1], CENTRE[1]], [0, 0, 1]])
    rays = np.array([[0.0, 0.0, 1.0], [0.3, -0.2, 1.0], [-0.35, 0.25, 1.0], [0.01, 0.3, 1.0]])
    ideal = rays[:, :2] * FOCAL + CENTRE + 0.5
    coefficients = np.array(lens.coefficients)
    if lens.model == "equidistant":
        theirs = cv2.fisheye.distortPoints(rays[np.newaxis, :, :2].copy(), matrix, coefficients)
    else:
        theirs, _ = cv2.projectPoints(rays, np.zeros(3), np.zeros(3), matrix, coefficients)
    assert lens.to_pixels(ideal) == pytest.approx(theirs.reshape(-1, 2) + 0.5, abs=1e-9)


def test_no_points_are_no_pixels(lens):
    assert lens.to_ideal(np.empty((0, 2))).shape == lens.to_pixels(np.empty((0, 2))).shape == (0, 2)


def test_removal_undoes_the_distortion(lens):
    ideal = lens.to_ideal(PIXELS)
    assert np.abs(ideal - PIXELS).max() > 1
    assert lens.to_pixels(ideal) == pytest.approx(PIXELS, abs=1e-6)


def test_radial_distortion_by_hand():
    # A ray at x = 0.5 with k1 = -0.2 is drawn to 0.5 (1 - 0.2 * 0.25) = 0.475.
    lens = Lens((100.0, 100.0), (-0.5, -0.5), "plumb_bob", (-0.2, 0.0, 0.0, 0.0))
    assert lens.to_pixels(np.array([50.0, 0.0])) == pytest.approx([47.5, 0.0])
    assert lens.to_ideal(np.array([47.5, 0.0])) == pytest.approx([50.0, 0.0])


def test_no_ray_beyond_the_fold():
    # r (1 - 0.5 r^2) has its largest value, 0.544, at r = 0.816.
    lens = Lens((100.0, 100.0), (-0.5, -0.5), "plumb_bob", (-0.5, 0.0, 0.0, 0.0))
    assert np.isfinite(lens.to_ideal(np.array([54.0, 0.0]))).all()
    assert np.isnan(lens.to_ideal(np.array([56.0, 0.0]))).all()


def test_of_several_pixels_only_those_without_a_ray_have_none():
    lens = Lens((100.0, 100.0), (-0.5, -0.5), "plumb_bob", (-0.5, 0.0, 0.0, 0.0))
    found = lens.to_ideal(np.array([[54.0, 0.0], [56.0, 0.0], [0.0, 30.0]]))
    assert np.isnan(found).all(axis=1).tolist() == [False, True, False]
    # A fisheye without coefficients shows a ray at theta at theta focal lengths, up to pi / 2.
    fisheye = Lens((100.0, 100.0), (-0.5, -0.5), "equidistant", (0.0,) * 4)
    found = fisheye.to_ideal(np.array([[25 * np.pi, 0.0], [200.0, 0.0]]))
    assert found[0] == pytest.approx([100.0, 0.0])
    assert np.isnan(found[1]).all()


def test_without_distortion_pixels_stay_to_the_bit():
    lens = Lens(FOCAL, CENTRE, "plumb_bob", (0.0,) * 5)
    assert lens.to_ideal(PIXELS) is PIXELS


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (((0.0, 1.0), CENTRE), "above 0"),
        ((FOCAL, (np.nan, 0.0)), "finite"),
        ((FOCAL, CENTRE, "thin_prism", ()), "not known"),
        ((FOCAL, CENTRE, "plumb_bob", (0.1,)), "4 or 5 coefficients"),
        ((FOCAL, CENTRE, "none", (0.1,)), "0 coefficients"),
    ],
)
def test_what_is_no_lens(arguments, words):
    with pytest.raises(InputError, match=words):
        Lens(*arguments)


def test_a_fisheye_bends_without_coefficients_too():
    # A ray at 45 degrees is drawn pi / 4 focal lengths from the centre, not one.
    lens = Lens((100.0, 100.0), (-0.5, -0.5), "equidistant", (0.0,) * 4)
    assert lens.to_pixels(np.array([100.0, 0.0])) == pytest.approx([25 * np.pi, 0.0])
    assert lens.to_ideal(np.array([25 * np.pi, 0.0])) == pytest.approx([100.0, 0.0])


def test_the_camera_matrix_counts_from_the_corner_of_the_first_pixel():
    expected = np.array([[800.0, 0, 320.0], [0, 820.0, 240.0], [0, 0, 1]])
    assert np.array_equal(Lens(FOCAL, CENTRE).matrix, expected)
