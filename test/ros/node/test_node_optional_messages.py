# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""vision_msgs and tf2_msgs over the wire: installed, or built once with the wheels' generators."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from geometry_msgs.msg import TransformStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from tracker_rig import HEIGHT, TARGET, WIDTH, Rig, overrides, road, values_of

from vehicle_pf_tracker.ros import messages as ros_messages
from vehicle_pf_tracker.ros.node import camera_inputs

pytestmark = [pytest.mark.ros, pytest.mark.slow]

NODE = "/apf_tracker"


def test_a_detection_starts_a_node_and_comes_back(bench, messages, monkeypatch):
    vision = messages("vision_msgs")
    for name in ("Detection2D", "ObjectHypothesisWithPose"):
        monkeypatch.setattr(ros_messages, name, getattr(vision, name))
    rig = Rig(bench, overrides())
    found = bench.collect(vision.Detection2D, f"{NODE}/detection")
    target = bench.publisher(vision.Detection2D, f"{NODE}/set_detection")
    wanted = vision.Detection2D()
    x, y, width, height = map(float, TARGET)
    wanted.bbox.center.position.x, wanted.bbox.center.position.y = x + width / 2, y + height / 2
    wanted.bbox.size_x, wanted.bbox.size_y = width, height
    target.publish(wanted)
    bench.wait_for(lambda: rig.node.feed.asked is not None)
    answers = [rig.show_frame(frame, index) for index, frame in enumerate(road(3))]
    bench.wait_for(lambda: len(found) == 3)
    assert found[0].bbox == wanted.bbox
    assert found[2].header == answers[2].header
    assert found[2].id == "1"
    assert found[2].bbox.center.position.x == float(values_of(answers[2])["x"])
    (result,) = found[2].results
    assert result.hypothesis.class_id == "vehicle"
    assert result.hypothesis.score == float(values_of(answers[2])["confidence"])
    target.publish(wanted)
    bench.wait_for(lambda: rig.node.feed.asked is not None)
    rig.show_frame(road(1)[0], 3)
    bench.wait_for(lambda: len(found) == 4)
    assert found[3].id == "2"
    wanted.bbox.center.theta = 1.0
    target.publish(wanted)
    bench.wait_for(lambda: rig.node.diagnostics.health.refusals.count == 1)


def test_the_camera_pose_comes_from_tf(bench, messages, monkeypatch):
    kind = messages("tf2_msgs").TFMessage
    monkeypatch.setattr(camera_inputs, "TFMessage", kind)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = bench.node.create_publisher(kind, "/tf_static", latched)
    transform = TransformStamped(child_frame_id="camera")
    transform.header.frame_id = "map"
    at, turn = transform.transform.translation, transform.transform.rotation
    at.x, at.y, at.z, turn.x, turn.w = 8.0, 6.0, 10.0, 1.0, 0.0
    publisher.publish(kind(transforms=[transform]))  # before the node is there: it is latched
    x, y, width, height = map(float, TARGET)
    parameters = overrides(
        target__x=x, target__y=y, target__width=width, target__height=height,
        road__from_tf=True, road__frame_id="map",
        road__intrinsics=f"100,100,{WIDTH / 2 - 0.5},{HEIGHT / 2 - 0.5}",
    )  # fmt: skip
    rig = Rig(bench, parameters)
    index = iter(range(1000))
    frame = road(1)[0]
    values = bench.wait_for(
        lambda: (said := values_of(rig.show_frame(frame, next(index))))["road"] == "ok" and said
    )
    assert float(values["road_x"]) == pytest.approx(8 + (float(values["x"]) - WIDTH / 2) / 10)
    assert float(values["road_y"]) == pytest.approx(
        6 - (float(values["y"]) + height / 2 - HEIGHT / 2) / 10
    )
