# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The calibrated road in the tracker of many vehicles: its horizon, and the order in depth."""

import numpy as np
import pytest
from traffic_samples import together, track

from laboratory.scenes import make_traffic_scene
from laboratory.scenes.perspective import looking
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.road.poses import Pose
from vehicle_pf_tracker.trackers.traffic.horizon import calibrated_row
from vehicle_pf_tracker.trackers.traffic.occlusion import nearest_first
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

SIZE = (640, 480)
LENS = Lens((800.0, 800.0), (319.5, 239.5))


def road(height=8.0, ahead=60.0, roll=0.0):
    pose = looking((0.0, 0.0, height), (0.0, ahead))
    c, s = np.cos(roll), np.sin(roll)
    turned = pose.rotation @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return RoadPlane.of_camera(LENS, Pose(turned, pose.position), coarsest=10.0)


def test_the_horizon_is_where_the_camera_sees_it():
    row = calibrated_row(road(), SIZE)
    assert row * SIZE[1] == pytest.approx(240 - 800 * 8 / 60, abs=1e-6)
    far = road().to_image(np.array([0.0, 1e7]))
    assert row * SIZE[1] == pytest.approx(far[1], abs=0.01)


def test_the_horizon_of_a_camera_that_looks_down_is_far_above():
    assert calibrated_row(road(ahead=0.5), SIZE) == pytest.approx(-1 / 0.3)


def standing(number, left, bottom):
    return track(number, left, bottom - 30.0)


def test_the_order_in_depth_is_that_on_the_road():
    lower, higher = standing(1, 500.0, 302.0), standing(2, 100.0, 300.0)
    both = together(higher, lower)
    assert nearest_first(both, None).tolist() == [1, 0]
    assert nearest_first(both, road()).tolist() == [1, 0]
    # The left of the image shows what is nearer, where the camera is rolled.
    (left, right) = (road(roll=-0.1).to_road(np.array(feet)) for feet in ((120, 300), (520, 302)))
    assert left[1] < right[1]
    assert nearest_first(both, road(roll=-0.1)).tolist() == [0, 1]


def predicted_error(is_calibrated, identity=2, seen=30, hidden=20):
    """Distance from the truth, in widths, of a box that was predicted through hidden frames."""
    scene = make_traffic_scene("traffic-overtaking")
    tracker = MultiVehicleTracker(
        TrafficParameters(pixels=False), scene.road if is_calibrated else None
    )
    frame = np.zeros((scene.height, scene.width, 3), np.uint8)
    truth = Box(0, 0, 1, 1)
    for index in range(100, 100 + seen + hidden):
        body = scene.vehicles[identity - 1][1]
        truth = body.path(index)
        box = (truth.x, truth.y, truth.width, truth.height)
        seen_now = [box] if index < 100 + seen else np.empty((0, 4))
        estimates = tracker.step(frame, Detections.make(seen_now))
    (one,) = estimates
    return np.hypot(*np.subtract(one.position, truth.centre)) / truth.width


def test_a_hidden_vehicle_is_predicted_better_with_the_road():
    with_road, without = predicted_error(True), predicted_error(False)
    assert with_road < 0.3
    assert with_road < without / 1.5
