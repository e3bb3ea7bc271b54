# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Box, velocity, particles, overlay: what they hold, and when they are made at all."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from geometry_msgs.msg import PolygonStamped, Vector3Stamped
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image, PointCloud2
from tracker_rig import HEIGHT, PERIOD_NS, SPEED, WIDTH, Rig, on_target, road, values_of

from vehicle_pf_tracker.ros import messages
from vehicle_pf_tracker.showing.target_drawing import Annotator

pytestmark = pytest.mark.ros


@pytest.fixture
def rig(bench):
    return Rig(bench, on_target())


def test_box_and_position_agree(bench, rig):
    boxes = bench.collect(PolygonStamped, "/apf_tracker/box")
    for index, frame in enumerate(road(3)):
        answer = rig.show_frame(frame, index)
    bench.wait_for(lambda: len(boxes) == 3)
    assert boxes[-1].header == answer.header
    told = {name: float(values_of(answer)[name]) for name in ("x", "y", "width", "height")}
    corners = np.array([(point.x, point.y) for point in boxes[-1].polygon.points])
    assert corners.mean(axis=0) == pytest.approx((told["x"], told["y"]), abs=1e-4)
    assert np.ptp(corners, axis=0) == pytest.approx((told["width"], told["height"]), abs=1e-4)
    assert corners[0].tolist() == corners.min(axis=0).tolist()


def test_velocity_is_in_px_per_second(bench, rig):
    velocities = bench.collect(Vector3Stamped, "/apf_tracker/velocity")
    for index, frame in enumerate(road(25)):
        answer = rig.show_frame(frame, index)
    bench.wait_for(lambda: len(velocities) == 25)
    per_second = 1e9 / PERIOD_NS
    vector = velocities[-1].vector
    assert vector.x == pytest.approx(SPEED * per_second, rel=0.2)
    assert vector.x == pytest.approx(float(values_of(answer)["velocity_x"]) * per_second)


def test_particles_come_while_subscribed(bench, rig, monkeypatch):
    frames = road(3)
    with monkeypatch.context() as patch:
        patch.setattr(messages, "particles_message", lambda *_: pytest.fail("nobody looks"))
        rig.play(frames[:1])
    clouds = bench.collect(PointCloud2, "/apf_tracker/particles", qos_profile_sensor_data)
    answer = rig.show_frame(frames[1], 1)
    bench.wait_for(lambda: clouds)
    cloud = clouds[0]
    assert cloud.header == answer.header
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "weight"]
    points = np.frombuffer(cloud.data, "<f4").reshape(cloud.width, 4)
    estimate = rig.node.feed.estimate
    assert points[:, :2] == pytest.approx(estimate.particles.astype(np.float32))
    assert points[:, 3].sum() == pytest.approx(1.0, rel=1e-5)
    assert not points[:, 2].any()


def test_the_overlay_is_drawn_while_subscribed(bench, rig, monkeypatch):
    drawn = []
    draw = Annotator.draw
    monkeypatch.setattr(Annotator, "draw", lambda *given: drawn.append(1) or draw(*given))
    frames = road(5)
    rig.play(frames[:2])
    assert drawn == []
    pictures = []
    watcher = bench.node.create_subscription(
        Image, "/apf_tracker/overlay", pictures.append, qos_profile_sensor_data
    )
    bench.wait_until_matched(watcher)
    answer = rig.show_frame(frames[2], 2)
    bench.wait_for(lambda: pictures)
    assert pictures[0].header == answer.header
    assert (pictures[0].width, pictures[0].height) == (WIDTH, HEIGHT)
    picture = np.frombuffer(pictures[0].data, np.uint8).reshape(HEIGHT, WIDTH, 3)
    assert 0.01 < (picture != frames[2]).any(axis=2).mean() < 0.5
    bench.node.destroy_subscription(watcher)
    bench.wait_for(lambda: rig.listeners("overlay") == 0)
    rig.play(frames[3:], first=3)
    assert len(drawn) == 1


def test_without_vision_msgs_there_are_no_such_topics(bench, monkeypatch):
    monkeypatch.setattr(messages, "Detection2D", None)
    names = {name for name, _ in Rig(bench, on_target()).node.get_topic_names_and_types()}
    assert not {name for name in names if "detection" in name}


def test_the_overlay_shows_waiting_too(bench):
    rig = Rig(bench)
    pictures = bench.collect(Image, "/apf_tracker/overlay", qos_profile_sensor_data)
    frame = road(1)[0]
    rig.show_frame(frame, 0)
    bench.wait_for(lambda: pictures)
    picture = np.frombuffer(pictures[0].data, np.uint8).reshape(HEIGHT, WIDTH, 3)
    changed = (picture != frame).any(axis=2)
    assert changed[:30].any()
    assert not changed[60:].any()


def test_messages_that_nobody_hears_are_not_made(bench, rig, monkeypatch):
    made = []
    for name in ("box_message", "velocity_message", "particles_message"):
        original = getattr(messages, name)

        def record(*arguments, name=name, original=original):
            made.append(name)
            return original(*arguments)

        monkeypatch.setattr(messages, name, record)
    frames = road(4)
    rig.play(frames[:2])
    assert made == []
    boxes = bench.collect(PolygonStamped, "/apf_tracker/box")
    rig.play(frames[2:], first=2)
    bench.wait_for(lambda: len(boxes) == 2)
    assert made == ["box_message"] * 2


def test_an_overlay_that_cannot_be_drawn_costs_no_image_its_answer(bench, monkeypatch):
    tried = []

    def fail(*_):
        tried.append(1)
        raise MemoryError

    rig = Rig(bench, on_target())
    monkeypatch.setattr(Annotator, "draw", fail)
    bench.collect(Image, "/apf_tracker/overlay", qos_profile_sensor_data)
    frames = road(4)
    assert rig.play(frames) == ["TRACKING"] * 4
    assert tried
