# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detections that come in on a topic: those that fit, and all that do not.

vision_msgs is no wheel: it is built from its definitions where it is not installed.
"""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from replay_rig import COMMAND
from sensor_msgs.msg import Image
from tracker_rig import FIRST_NS, PERIOD_NS, QUEUE, diagnostics_of, header, overrides, values_of
from traffic_rig import NODE, WARM_UP, TrafficRig, boxes, hear_notices, lanes

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.ros import messages as ros_messages
from vehicle_pf_tracker.ros.messages import image_message, stamp_ns
from vehicle_pf_tracker.ros.traffic import traffic_node
from vehicle_pf_tracker.ros.traffic.traffic_node import TrafficNode
from vehicle_pf_tracker.ros.traffic.waiting_images import WaitingImages
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

pytestmark = [pytest.mark.ros, pytest.mark.slow]

FIRST = WARM_UP + 6
"""First image with both vehicles well in it."""
COUNT = 16
MOST = 40
"""Images in which both vehicles are."""


@pytest.fixture
def vision(messages, monkeypatch):
    module = messages("vision_msgs")
    for name in ("Detection2D", "Detection2DArray", "ObjectHypothesisWithPose"):
        monkeypatch.setattr(ros_messages, name, getattr(module, name))
    return module


class Clock:
    """Steady time in s that stands still unless a test moves it."""

    now = 0.0

    def __call__(self):
        return self.now


class DetectorRig(TrafficRig):
    """A node that takes detections from a topic, a detector, and the lines of the log."""

    def __init__(self, bench, vision, monkeypatch, **parameters):
        given = {"detector__max_wait": 20.0, **parameters}
        self.said = hear_notices(monkeypatch)
        self.clock = Clock()
        self.waiting = WaitingImages(self.clock)
        monkeypatch.setattr(traffic_node, "WaitingMessages", lambda: self.waiting)
        super().__init__(bench, overrides(detector__kind="topic", **given))
        self.vision = vision
        self.detector = bench.publisher(vision.Detection2DArray, "detections", QUEUE)
        self.frames = lanes(FIRST + MOST)[FIRST:]
        self.next = 0

    def message(self, rows, index, **results):
        """Make detections of (left, top, width, height, score)."""
        made = self.vision.Detection2DArray(header=header(index))
        for x, y, width, height, score in rows:
            one = self.vision.Detection2D()
            one.bbox.center.position.x = float(x + width / 2)
            one.bbox.center.position.y = float(y + height / 2)
            one.bbox.size_x, one.bbox.size_y = float(width), float(height)
            result = self.vision.ObjectHypothesisWithPose()
            result.hypothesis.class_id, result.hypothesis.score = "car", score
            one.results = [result]
            made.detections.append(one)
        return made

    def truth(self, index):
        return [(*box, 0.9) for box in boxes(FIRST + index)]

    def send(self, index, rows=None):
        """Publish an image and then its detections; without `rows` the true ones."""
        self.camera.publish(image_message(header(index), self.frames[index]))
        self.detector.publish(self.message(self.truth(index) if rows is None else rows, index))

    def answered(self, index, rows=None):
        """Send, and wait for the answer."""
        before = len(self.modes)
        self.send(index, rows)
        self.bench.wait_for(lambda: len(self.modes) > before)
        assert len(self.modes) == before + 1
        assert self.modes[-1].header == header(index)
        return values_of(self.modes[-1])

    def follow(self):
        """Give true detections until both vehicles are followed; returns their numbers."""
        while self.vehicles.summary()["vehicles TRACKING"] < 2:
            self.answered(self.next)
            self.next += 1
        return {one.identity for one in self.vehicles.estimates}


@pytest.fixture
def rig(bench, vision, monkeypatch):
    return DetectorRig(bench, vision, monkeypatch)


def test_vehicles_are_followed_as_offline_with_the_same_detections(rig):
    tracker = TrafficSession(MultiVehicleTracker(TRAFFIC_VARIANT.parameters()))
    out = rig.bench.collect(rig.vision.Detection2DArray, f"{NODE}/detections", QUEUE)
    for index in range(COUNT):
        rig.answered(index)
        rows = rig.truth(index)
        found = Detections.make([row[:4] for row in rows], [row[4] for row in rows], ["car"] * 2)
        expected = tracker.feed(rig.frames[index], 10**9 + index * PERIOD_NS, found)
        assert rig.vehicles.estimates == expected
    assert [one.identity for one in expected] == [1, 2]
    rig.bench.wait_for(lambda: len(out) == COUNT)
    assert [one.id for one in out[-1].detections] == ["1", "2"]
    assert out[-1].header == header(COUNT - 1)
    assert out[-1].detections[0].bbox.size_x == expected[0].box.width
    assert out[-1].detections[0].results[0].hypothesis.class_id == "car"
    assert rig.said == []


def test_a_detector_that_stops_is_told_once_and_vehicles_stay(bench, vision, monkeypatch):
    rig = DetectorRig(bench, vision, monkeypatch, detector__max_wait=0.05)
    before = rig.follow()
    for index in range(rig.next, rig.next + 4):
        rig.camera.publish(image_message(header(index), rig.frames[index]))
        rig.bench.wait_for(lambda: len(rig.waiting))
        answered, rig.clock.now = len(rig.modes), rig.clock.now + 1.0
        rig.bench.wait_for(lambda: len(rig.modes) > answered)  # noqa: B023 - called at once
    assert {one.identity for one in rig.vehicles.estimates} == before
    assert rig.waiting.missed == 4
    assert len(rig.said) == 1
    assert "1 images waited in vain for detections" in rig.said[0]


def test_messages_that_are_no_detections_are_told_once(rig):
    numbers = rig.follow()
    for index in range(rig.next, rig.next + 3):
        rig.camera.publish(image_message(header(index), rig.frames[index]))
        whole = serialize_message(rig.message(rig.truth(index), index))
        before = len(rig.modes)
        rig.detector.publish(whole[:80])
        rig.bench.wait_for(lambda: len(rig.modes) > before)  # noqa: B023 - called at once
    assert {one.identity for one in rig.vehicles.estimates} == numbers
    words = "80 bytes came that are not of the type Detection2DArray"
    assert sum(words in line for line in rig.said) == 1


def test_a_detector_may_answer_every_third_image(bench, vision, monkeypatch):
    rig = DetectorRig(bench, vision, monkeypatch, detector__every=3)
    tracker = TrafficSession(MultiVehicleTracker(TRAFFIC_VARIANT.parameters()))
    for index in range(COUNT - 1):
        found = None
        if index % 3:
            rig.show(image_message(header(index), rig.frames[index]))
        else:
            rig.answered(index)
            rows = rig.truth(index)
            found = Detections.make([row[:4] for row in rows], [0.9, 0.9], ["car", "car"])
        expected = tracker.feed(rig.frames[index], 10**9 + index * PERIOD_NS, found)
        assert rig.vehicles.estimates == expected
    assert (rig.waiting.matched, rig.waiting.missed) == (5, 0)
    assert rig.said == []


def test_a_lockstep_replay_waits_for_the_detector(rig, start_process, tmp_path):
    tracker, expected = TrafficSession(MultiVehicleTracker(TRAFFIC_VARIANT.parameters())), []
    with RecordingWriter(tmp_path / "bag") as writer:
        for index, frame in enumerate(rig.frames[:COUNT]):
            writer.write_image(FIRST_NS + index * PERIOD_NS, frame)
            rows = rig.truth(index)
            found = Detections.make([row[:4] for row in rows], [0.9, 0.9], ["car", "car"])
            expected.append(tracker.feed(frame, FIRST_NS + index * PERIOD_NS, found))
    answers = []

    def detect(image):
        answers.append(rig.vehicles.estimates)  # of the image before
        index = (stamp_ns(image.header) - FIRST_NS) // PERIOD_NS
        rig.detector.publish(rig.message(rig.truth(index), index))

    rig.bench.node.create_subscription(Image, "image", detect, QUEUE)
    replay = start_process(
        *COMMAND, str(tmp_path / "bag"), "--no-target", "--lockstep", "--node", "traffic_tracker",
        "--remap", "/camera/image_raw:=/image", "--timeout", "20",
    )  # fmt: skip
    rig.bench.wait_for(lambda: replay.popen.poll() is not None)
    assert f"/traffic_tracker: {COUNT} answered, 0 not" in replay.output
    assert [*answers[1:], rig.vehicles.estimates] == expected
    assert rig.waiting.matched == COUNT


def test_a_detector_may_publish_best_effort(bench, vision):
    override = {"qos_overrides./detections.subscription.reliability": "best_effort"}
    node = bench.add(
        TrafficNode(
            context=bench.context,
            parameter_overrides=[
                *overrides(detector__kind="topic"),
                *(Parameter(name, value=value) for name, value in override.items()),
            ],
        )
    )
    qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    bench.publisher(vision.Detection2DArray, "detections", qos)  # waits until it is matched
    bench.remove(node)
    with pytest.raises(InputError, match="the QoS overrides of /detections do not fit"):
        TrafficNode(
            context=bench.context,
            parameter_overrides=[
                *overrides(detector__kind="topic"),
                *(Parameter(name, value="perhaps") for name in override),
            ],
        )


def test_the_memory_of_a_flood_is_freed(bench, vision, start_node, monkeypatch):
    """Each buffer of a reader that ever held a flood would keep its size, 17 of them."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))  # for the node, of vision_msgs
    # Best effort loses an image that is published before the node has found its publisher.
    reliable = "qos_overrides./image.subscription.reliability:=reliable"
    words = ["detector.kind:=topic", "detector.max_wait:=20.0", "queue_depth:=50", reliable]
    arguments = [word for one in words for word in ("-p", one)]
    # Fresh: one that is forked has looked for vision_msgs without this path.
    node = start_node("traffic", *arguments, fresh=True)
    node.wait_for_output("ready")
    camera = bench.publisher(Image, "image", QUEUE)
    detector = bench.publisher(vision.Detection2DArray, "detections", QUEUE)
    modes = bench.collect(DiagnosticArray, f"{NODE}/mode", QUEUE)
    frame = lanes(1)[0]

    def show(count):
        for _ in range(count):
            before = len(modes)
            camera.publish(image_message(header(before), frame))
            detector.publish(vision.Detection2DArray(header=header(before)))
            bench.wait_for(lambda: len(modes) > before)  # noqa: B023 - called at once

    def resident():
        pages = Path("/proc", str(node.popen.pid), "statm").read_text().split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE") / 1e6

    def readers():
        found = bench.node.get_subscriptions_info_by_topic("/detections")
        return [one.endpoint_gid for one in found]

    show(20)
    usual, before = resident(), readers()
    flood = serialize_message(vision.Detection2DArray(header=header(0))) + bytes(4_400_000)
    for _ in range(20):
        detector.publish(flood)
    bench.wait_for(lambda: resident() > usual + 20)
    bench.wait_for(lambda: resident() < usual + 5)
    bench.wait_for(lambda: readers() not in ([], before))
    bench.wait_until_matched(detector)
    show(5)
    told = diagnostics_of(bench, "traffic_tracker", lambda table: table["images"] == "25")
    assert (told["images with detections"], told["images without detections"]) == ("25", "0")


def test_turned_boxes_and_those_without_a_class_are_read(rig):
    made = rig.message([(10, 20, 30, 10, 0.5), (60, 70, 20, 10, 0.4)], 0)
    made.detections[0].bbox.center.theta = math.pi / 2
    made.detections[1].results = []
    rig.camera.publish(image_message(header(0), rig.frames[0]))
    rig.detector.publish(made)
    rig.bench.wait_for(lambda: rig.modes)
    first, second = rig.vehicles.estimates
    assert (first.box.x, first.box.y) == pytest.approx((20, 10))
    assert (first.box.width, first.box.height) == pytest.approx((10, 30))
    assert (first.label, second.label, second.score) == ("car", "", 1.0)
