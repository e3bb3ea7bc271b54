# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Prediction along the road, from one frame to the next."""

import numpy as np

from laboratory.scenes import make_traffic_scene
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker


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
