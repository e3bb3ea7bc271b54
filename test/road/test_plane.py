# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from road_samples import BENT, LENS, camera_plane, pairs_of, pose

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import Pair, RoadPlane, convex_hull, is_inside, residuals
from vehicle_pf_tracker.road.poses import Pose

CORNERS = [(-5.0, 20.0), (5.0, 20.0), (5.0, 60.0), (-5.0, 60.0)]


def test_the_middle_of_the_image_is_where_the_axis_meets_the_road():
    # 8 m up and 0.3 rad down: the axis meets the ground 8 / tan(0.3) m ahead.
    found = camera_plane().to_road(np.array([320.0, 240.0]))
    assert found == pytest.approx([0.0, 8 / np.tan(0.3)])


def test_a_camera_that_looks_straight_down():
    down = Pose(np.diag([1.0, -1.0, -1.0]), np.array([3.0, 4.0, 10.0]))
    plane = RoadPlane.of_camera(LENS, down, coarsest=1.0)
    # 800 px of focal length over 10 m: 80 px to the metre, and v downwards.
    assert plane.to_road(np.array([400.0, 160.0])) == pytest.approx([4.0, 5.0])
    assert plane.pixel_length(np.array([99.0, 77.0])) == pytest.approx(1 / 80)


@pytest.mark.parametrize("lens", [LENS, BENT])
def test_pairs_of_a_camera_give_the_camera(lens):
    camera = camera_plane(lens)
    pairs = pairs_of(camera, [*CORNERS, (0.0, 35.0)])
    plane = RoadPlane.of_pairs(pairs, lens, margin=0.0, coarsest=1.0)
    in_image, on_road = residuals(plane, pairs)
    assert in_image.max() < 1e-6
    assert on_road.max() < 1e-6
    pixel = np.array([300.0, 260.0])
    assert plane.to_road(pixel) == pytest.approx(camera.to_road(pixel), abs=1e-6)


def test_distortion_matters_and_is_removed():
    pixel = np.array([80.0, 400.0])
    bent, straight = camera_plane(BENT).to_road(pixel), camera_plane(LENS).to_road(pixel)
    assert np.linalg.norm(bent - straight) > 0.2


def test_outside_the_area_is_said():
    plane = RoadPlane.of_pairs(pairs_of(camera_plane(), CORNERS), None, margin=0.1, coarsest=1.0)
    middle = np.array([320.0, 260.0])
    assert plane.objection(middle) == ""
    assert plane.objection(np.array([20.0, 460.0])) == "outside the calibrated area"
    assert "horizon" in plane.objection(np.array([320.0, -60.0]))
    corner = plane.to_image(np.array(CORNERS[0]))
    outwards = corner - plane.hull.mean(axis=0)
    assert plane.objection(corner + 0.05 * outwards) == ""  # within the margin
    assert plane.objection(corner + 0.2 * outwards) == "outside the calibrated area"


def test_too_far_away_is_said():
    plane = camera_plane()
    # On the axis' column a pixel at distance d is d^2 / (800 * 8) m long, roughly.
    assert plane.objection(plane.to_image(np.array([0.0, 70.0]))) == ""
    assert "too far away" in plane.objection(plane.to_image(np.array([0.0, 95.0])))


@pytest.mark.parametrize("height", [-1.0, 0.0])
def test_cameras_that_see_no_road(height):
    camera = Pose(pose().rotation, np.array([0.0, 0.0, height]))
    with pytest.raises(InputError, match="above it"):
        RoadPlane.of_camera(LENS, camera, coarsest=1.0)


@given(st.integers(0, 2**32 - 1), st.integers(4, 30))
def test_a_hull_holds_its_points(seed, count):
    points = np.random.default_rng(seed).normal(size=(count, 2))
    hull = convex_hull(points)
    middle = points.mean(axis=0)
    assert all(is_inside(hull, middle + (point - middle) * (1 - 1e-9)) for point in points)
    assert set(map(tuple, hull)) <= set(map(tuple, points))


@given(st.floats(-10, 10), st.floats(13, 80))
def test_round_trip_through_lens_and_plane(x, y):
    plane = camera_plane(BENT)
    assert plane.to_road(plane.to_image(np.array([x, y]))) == pytest.approx([x, y], abs=1e-6)


def test_pixels_without_a_ray_are_outside():
    # 1.2 focal lengths beside the axis, k1 = -0.5 has folded the image long before.
    lens = Lens((800.0, 800.0), (319.5, 239.5), "plumb_bob", (-0.5, 0.0, 0.0, 0.0))
    pairs = pairs_of(camera_plane(), CORNERS)
    far = Pair((320.0 + 960.0, 240.0), (50.0, 20.0))
    with pytest.raises(InputError, match="outside what the lens can show"):
        RoadPlane.of_pairs([*pairs, far], lens, margin=0.0, coarsest=1.0)
    plane = camera_plane(lens)
    assert plane.objection(plane.ideal(np.array(far.pixel))) == "outside what the lens can show"


def test_a_camera_that_looks_along_the_road_plane():
    # In the plane z = 0 itself nothing of it is seen; a hair above, the view is along it.
    along = Pose(np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]), np.array([0.0, 0.0, 1e-15]))
    with pytest.raises(InputError, match=r"^the camera's view lies within the road's plane$"):
        RoadPlane.of_camera(LENS, along, coarsest=1.0)


def test_the_margin_is_a_share_of_the_way_from_the_middle():
    square = [Pair(place, place) for place in ((0, 0), (100, 0), (100, 100), (0, 100))]
    plane = RoadPlane.of_pairs(square, None, margin=0.2, coarsest=10.0)
    assert sorted(map(tuple, np.round(plane.hull, 6))) == [
        (-10, -10), (-10, 110), (110, -10), (110, 110)
    ]  # fmt: skip
    assert plane.objection(np.array([109.0, 50.0])) == ""
    assert plane.objection(np.array([111.0, 50.0])) == "outside the calibrated area"


def test_an_edge_belongs_to_the_hull():
    square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    for inside in ((5.0, 0.0), (10.0, 10.0), (0.0, 3.0)):
        assert is_inside(square, np.array(inside))
    for outside in ((5.0, -1e-9), (10.0 + 1e-9, 5.0), (-1e-9, 3.0), (5.0, 10.0 + 1e-9)):
        assert not is_inside(square, np.array(outside))


def test_residuals_are_distances_in_px_and_m():
    square = [Pair((10 * x, 10 * y), (x, y)) for x, y in ((0, 0), (10, 0), (10, 10), (0, 10))]
    plane = RoadPlane.of_pairs(square, None, margin=0.0, coarsest=10.0)
    in_image, on_road = residuals(plane, [Pair((53.0, 54.0), (5.0, 5.0))])
    assert (in_image[0], on_road[0]) == pytest.approx((5.0, 0.5))
