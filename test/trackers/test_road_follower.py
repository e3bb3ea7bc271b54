# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from estimate_samples import estimate

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.road.homography import Homography
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.road.poses import Pose
from vehicle_pf_tracker.trackers.estimate import START_REGIME, Mode
from vehicle_pf_tracker.trackers.localisation import Localisation
from vehicle_pf_tracker.trackers.road_follower import ROAD_COLUMNS, Contact, RoadFollower

PERIOD = 40_000_000
TENTH = RoadPlane(Homography(np.diag([0.1, 0.1, 1.0])), None, None, 1.0)
"""Seen from straight above: 10 px to the metre."""
LENS = Lens((800.0, 800.0), (319.5, 239.5))


def camera(pitch=0.25, height=8.0):
    """Camera that looks along y, and its plane."""
    down, ahead = np.sin(pitch), np.cos(pitch)
    axes = np.column_stack([(1, 0, 0), (0, -down, -ahead), (0, ahead, -down)])
    pose = Pose(axes.astype(float), np.array([0.0, 0.0, height]))
    return pose, RoadPlane.of_camera(LENS, pose, coarsest=1.0)


def seen(pose, point):
    """Pixel of a point (x, y, z; m)."""
    local = (np.asarray(point) - pose.position) @ pose.rotation
    return local[:2] / local[2] * 800 + [320, 240]


def drive(follower, points, covariance=None, first=0, **options):
    """Follow estimates at pixels; the first one starts a track."""
    results = []
    for index, point in enumerate(points, first):
        regime = START_REGIME if index == 0 else "clear"
        one = estimate(tuple(map(float, point)), regime=regime, **options)
        covariance_px = np.eye(2) * 0.01 if covariance is None else covariance
        results.append(follower.follow(one, covariance_px, index * PERIOD))
    return results


def test_speed_from_straight_above():
    follower = RoadFollower(TENTH, 1.0)
    # 4 px in 40 ms are 0.4 m in 0.04 s: 10 m/s, 36 km/h; the box's lower edge is 5 px below.
    last = drive(follower, [(50 + 4 * index, 80) for index in range(50)])[-1]
    assert last.position == pytest.approx([(50 + 4 * 49) / 10, 8.5])
    assert last.velocity == pytest.approx([10.0, 0.0], abs=0.01)
    assert last.speed == pytest.approx(36.0, abs=0.04)
    assert 0 < last.speed_deviation < 1
    assert last.covariance == pytest.approx(np.eye(2) * 1e-4)
    assert tuple(last.scalars()) == ROAD_COLUMNS
    assert last.scalars()["speed_kmh"] == last.speed


def test_the_contact_stays_the_same_point_of_the_vehicle():
    # The middle of a vehicle 1.5 m high is followed: what is on the road 0.75 m below it moves on
    # the road as the vehicle does, from 50 m to 25 m away, where it is twice as large.
    pose, plane = camera()
    ways = np.linspace(50, 25, 26)
    middles = [seen(pose, (1.0, y, 0.75)) for y in ways]
    first = seen(pose, (1.0, 50.0, 0.0))
    box = Box.around(tuple(middles[0]), 10.0, 2 * (first - middles[0])[1])
    contact = Contact.of(plane, box)
    found = [plane.homography.to_road(contact.point(middle)) for middle in middles]
    # To 0.4 %: the camera looks down on it the more the nearer it is.
    assert np.array(found)[:, 1] == pytest.approx(ways, rel=4e-3)
    # Without that, the middle itself would be taken for a point 8 / 7.25 times as far away.
    naive = plane.to_road(np.array(middles))[:, 1]
    assert naive == pytest.approx(ways * 8 / 7.25, rel=1e-6)


def test_covariance_is_carried_to_the_road():
    pose, plane = camera()
    contact = Contact.of(plane, Box.around(tuple(seen(pose, (0.0, 40.0, 0.75))), 20.0, 12.0))
    centre = seen(pose, (0.0, 40.0, 0.75))
    jacobian = contact.jacobian(centre)
    rng = np.random.default_rng(1)
    noise = rng.normal(scale=0.2, size=(4000, 2))
    cloud = np.array([plane.homography.to_road(contact.point(centre + one)) for one in noise])
    assert np.cov(cloud.T) == pytest.approx(0.04 * jacobian @ jacobian.T, rel=0.15, abs=2e-4)


def test_hidden_speed_stays_and_its_deviation_grows():
    follower = RoadFollower(TENTH, 1.0)
    points = [(50 + 4 * index, 80) for index in range(40)]
    before = drive(follower, points)[-1]
    hidden = drive(follower, [(0.0, 80)] * 10, first=40, mode=Mode.OCCLUDED)
    assert all(one.velocity == pytest.approx(before.velocity) for one in hidden)
    deviations = [before.speed_deviation, *(one.speed_deviation for one in hidden)]
    assert all(np.diff(deviations) > 0)


def test_lost_vehicles_and_places_outside_have_no_road():
    plane = RoadPlane(
        TENTH.homography, None, np.array([[0, 0], [200, 0], [200, 200], [0, 200.0]]), 1.0
    )
    follower = RoadFollower(plane, 1.0)
    assert drive(follower, [(50, 50), (54, 50)])[-1] is not None
    assert follower.objection == ""
    assert drive(follower, [(190, 197)], first=2) == [None]
    assert follower.objection == "outside the calibrated area"
    assert drive(follower, [(58, 50)], first=3, mode=Mode.LOST) == [None]
    assert follower.objection == "the vehicle is lost"
    assert drive(follower, [(62, 50)], first=4)[-1] is not None


def test_a_target_above_the_horizon_has_no_road_and_does_no_harm():
    _, plane = camera()
    follower = RoadFollower(plane, 1.0)
    found = drive(follower, [(320, -200), (320, -200), (320, 300)])
    assert found == [None] * 3
    assert follower.objection == "the track began above the horizon of the road"


def test_time_that_goes_back_or_leaps_begins_the_speed_anew():
    follower = RoadFollower(TENTH, 1.0)
    settled = drive(follower, [(50 + 4 * index, 80) for index in range(40)])[-1]
    for first in (2, 1000):
        again = drive(follower, [(200, 80)], first=first)[-1]
        assert again.speed == 0
        assert again.speed_deviation > 100 * settled.speed_deviation
    repeated = drive(follower, [(200, 80)], first=1000)[-1]
    assert repeated.speed == 0


PAIRS = "0,0=0,0; 1000,0=100,0; 1000,1000=100,100; 0,1000=0,100"


def test_localisation_of_pairs():
    local = Localisation("pf", RoadParameters(pairs=PAIRS))
    for index in range(30):
        regime = START_REGIME if index == 0 else "clear"
        local.follow(estimate((50.0 + 4 * index, 80.0), regime=regime), index * PERIOD, 0.04)
    assert local.road.speed == pytest.approx(36, abs=2)
    assert local.objection == ""
    local.reconfigure(RoadParameters())
    local.follow(estimate(), 30 * PERIOD, 0.04)
    assert local.road is None
    assert local.covariance.shape == (2, 2)


def test_localisation_waits_for_lens_and_pose():
    pose, plane = camera()
    local = Localisation("pf", RoadParameters(from_camera_info=True, from_tf=True, frame_id="map"))
    centre = tuple(plane.to_image(np.array([0.0, 40.0])))
    follow = lambda stamp: local.follow(estimate(centre), stamp, 0.04)  # noqa: E731
    follow(0)
    assert (local.road, local.objection) == (None, "no camera_info yet")
    local.set_lens(LENS)
    assert local.objection == "no transform from map to the camera yet"
    local.set_pose(Pose(pose.rotation, -pose.position))
    assert "must be above it" in local.objection
    local.set_pose(pose)
    follow(PERIOD)
    assert local.objection == ""
    # The contact is 5 px below the middle, which was 40 m away.
    assert local.road.position == pytest.approx(plane.to_road(np.add(centre, [0, 5])), rel=1e-6)
    # The camera turns a little: the place changes, and the track goes on.
    turned, _ = camera(0.26)
    local.set_pose(turned)
    follow(2 * PERIOD)
    assert local.road.position[1] < 38


def test_a_new_start_begins_the_speed_anew():
    follower = RoadFollower(TENTH, 1.0)
    drive(follower, [(50 + 4 * index, 80) for index in range(40)])
    one = estimate((400.0, 80.0), regime=START_REGIME)
    assert follower.follow(one, np.eye(2), 40 * PERIOD).speed == 0


def test_parameters_that_ask_for_nothing_from_outside_take_nothing():
    local = Localisation("pf", RoadParameters(pairs=PAIRS))
    local.set_lens(Lens((1.0, 1.0), (0.0, 0.0)))
    local.set_pose(Pose(np.eye(3), np.zeros(3)))
    local.follow(estimate(regime=START_REGIME), 0, 0.04)
    assert local.road.position == pytest.approx([10.0, 8.5])
