# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A tracker node and somebody who shows it images and listens to its answers."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from vehicle_pf_tracker.ros.messages import image_message, stamp_ns
from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode
from vehicle_pf_tracker.trackers.registry import VARIANTS, find_variant

WIDTH, HEIGHT = 160, 120
TARGET = (20, 50, 24, 18)
SPEED = 2
FIRST_NS = 1_000_000_000
PERIOD_NS = 40_000_000
QUEUE = QoSProfile(depth=50)
SOME_FAST = [
    pytest.param(name, marks=() if name in {"apf", "ms", "mfpf", "fusion"} else pytest.mark.slow)
    for name in VARIANTS
]
"""Every variant; those whose nodes differ from the others' by nothing but their table are slow."""


def road(count: int, width: int = WIDTH, height: int = HEIGHT) -> list[np.ndarray]:
    """Frames of a two-coloured vehicle that moves right over noise at `SPEED` px per frame."""
    noise = np.random.default_rng(7).integers(90, 130, (height, width, 3), np.uint8)
    frames = []
    for index in range(count):
        frame = noise.copy()
        x, y, w, h = TARGET
        x += SPEED * index
        frame[y : y + h, x : x + w] = (200, 40, 30)
        frame[y : y + h // 2, x : x + w] = (30, 60, 210)
        frames.append(frame)
    return frames


def header(index: int, frame_id: str = "camera") -> Header:
    return header_at(FIRST_NS + index * PERIOD_NS, frame_id)


def header_at(nanoseconds: int, frame_id: str = "camera") -> Header:
    made = Header(frame_id=frame_id)
    made.stamp.sec, made.stamp.nanosec = divmod(nanoseconds, 1_000_000_000)
    return made


def overrides(**values) -> list[Parameter]:
    """Parameters by name, with `__` for the dot."""
    return [Parameter(name.replace("__", "."), value=value) for name, value in values.items()]


def on_target(**values) -> list[Parameter]:
    x, y, width, height = map(float, TARGET)
    return overrides(target__x=x, target__y=y, target__width=width, target__height=height, **values)


def values_of(answer: DiagnosticArray) -> dict[str, str]:
    return {item.key: item.value for item in answer.status[0].values}


def diagnostics_of(bench, name: str, accept, timeout: float = 20.0) -> dict[str, str]:
    """The values of the next report of the node `name` that `accept` takes."""
    heard: list[DiagnosticArray] = []
    listener = bench.node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)

    def found():
        tables = [values_of(one) for one in heard if one.status[0].name.startswith(f"{name}:")]
        return next((table for table in tables if accept(table)), None)

    table = bench.wait_for(found, timeout)
    bench.node.destroy_subscription(listener)
    return table


class Rig:
    """The node under test, a publisher of images, and everything that it answered."""

    def __init__(self, bench, parameters=(), variant: str = "apf", kind=Image, topic="image"):
        self.bench = bench
        self.kind = kind
        self.node = bench.add(
            TrackerNode(
                find_variant(variant),
                context=bench.context,
                parameter_overrides=[Parameter("queue_depth", value=50), *parameters],
            )
        )
        bench.wait_for(lambda: self.node.feed is None or self.node.feed.get_ready())
        self.name = f"/{variant}_tracker"
        self.camera = bench.publisher(kind, topic, QUEUE)
        self.modes = bench.collect(DiagnosticArray, f"{self.name}/mode", QUEUE)
        self.positions = bench.collect(PointStamped, f"{self.name}/position", QUEUE)

    def callback(self, topic):
        """Callback of the node for messages of a topic that it has subscribed to."""
        return next(one.callback for one in self.node.subscriptions if one.topic_name == topic)

    def listeners(self, output: str) -> int:
        """Subscriptions that the node's publisher of `output` is matched with."""
        topic = f"{self.name}/{output}"
        return sum(
            one.get_subscription_count() for one in self.node.publishers if one.topic_name == topic
        )

    def wait_until_heard(self):
        """Wait until the node, active again, hears the camera and is heard."""
        self.bench.wait_until_matched(self.camera)
        self.bench.wait_for(lambda: self.listeners("mode") == 1)

    def show(self, message) -> DiagnosticArray:
        """Publish one image and return its one answer."""
        before = len(self.modes)
        self.camera.publish(message)
        self.bench.wait_for(lambda: len(self.modes) > before)
        answer = self.modes[-1]
        assert len(self.modes) == before + 1
        assert answer.header == message.header
        return answer

    def show_frame(self, frame: np.ndarray, index: int) -> DiagnosticArray:
        return self.show(image_message(header(index), frame))

    def play(self, frames, first: int = 0) -> list[str]:
        """Show frames with stamps in step; return what each mode said."""
        answers = [self.show_frame(frame, first + index) for index, frame in enumerate(frames)]
        return [answer.status[0].message for answer in answers]

    def position_at(self, answer: DiagnosticArray) -> PointStamped:
        """Wait for the position of an answered image."""
        wanted = stamp_ns(answer.header)

        def found():
            return next((p for p in self.positions if stamp_ns(p.header) == wanted), None)

        return self.bench.wait_for(found)


def ended_by_failures(bench, node, topic: str) -> None:
    """Show a node good images until it has ended; each is answered."""
    node.wait_for_output("ready")
    camera = bench.publisher(Image, "image", QUEUE)
    answers = bench.collect(DiagnosticArray, topic, QUEUE)
    frame = road(1)[0]
    bench.publish_until(lambda: answers, camera, image_message(header(0), frame))
    for index in itertools.count(1):
        count = len(answers)
        camera.publish(image_message(header(index), frame))
        bench.wait_for(lambda: len(answers) > count or node.popen.poll() is not None)  # noqa: B023
        if node.popen.poll() is not None:
            break
    assert node.wait() == 1
    assert "20 callbacks failed within 10 s: ending" in node.output
    assert {answer.status[0].message for answer in answers} == {"REJECTED"}
