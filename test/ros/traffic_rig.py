# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A camera over two lanes, the node under test, and everything that it answered."""

from __future__ import annotations

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.parameter import Parameter
from sensor_msgs.msg import Image, PointCloud2
from tracker_rig import QUEUE, header

from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.node import journal
from vehicle_pf_tracker.ros.node.notices import Notices
from vehicle_pf_tracker.ros.traffic.traffic_node import TrafficNode

WIDTH, HEIGHT = 160, 120
NODE = "/traffic_tracker"
WARM_UP = 20
"""Images of the empty road, more than the background is learnt from."""


def boxes(index: int) -> list[tuple[int, int, int, int]]:
    """Left, top, width, height of the vehicles in an image, px: one to the right, one back."""
    if index < WARM_UP:
        return []
    way = 3 * (index - WARM_UP)
    return [(way - 10, 30, 28, 18), (WIDTH - 10 - way, 80, 34, 22)]


def lanes(count: int) -> list[np.ndarray]:
    """Frames of two vehicles that drive past each other, after an empty road."""
    noise = np.random.default_rng(7).integers(100, 112, (HEIGHT, WIDTH, 3), np.uint8)
    frames = []
    for index in range(count):
        frame = noise.copy()
        for (x, y, width, height), colour in zip(
            boxes(index), [(200, 40, 30), (30, 60, 210)], strict=False
        ):
            frame[y : y + height, max(x, 0) : max(x + width, 0)] = colour
            frame[y + 4 : y + 8, max(x + 6, 0) : max(x + width - 6, 0)] = (240, 240, 230)
        frames.append(frame)
    return frames


def hear_notices(monkeypatch) -> list[str]:
    """Sentences that nodes made from now on log: each kind once, however long the test takes."""
    said: list[str] = []
    monkeypatch.setattr(journal, "Notices", lambda _: Notices(said.append, lambda: 0.0))
    return said


class TrafficRig:
    """The node, a publisher of images, and its answers."""

    def __init__(self, bench, parameters=(), kind=Image, topic="image", **options):
        self.bench = bench
        self.node = bench.add(
            TrafficNode(
                context=bench.context,
                parameter_overrides=[Parameter("queue_depth", value=50), *parameters],
                **options,
            )
        )
        self.camera = bench.publisher(kind, topic, QUEUE)
        self.modes = bench.collect(DiagnosticArray, f"{NODE}/mode", QUEUE)
        self.tracks = bench.collect(PointCloud2, f"{NODE}/tracks", QUEUE)
        self.statuses = bench.collect(DiagnosticArray, f"{NODE}/modes", QUEUE)

    @property
    def vehicles(self):
        return self.node.feed.vehicles

    def show(self, message, answers: int = 1) -> DiagnosticArray:
        """Publish one image, and return the last of the answers that came."""
        before = len(self.modes)
        self.camera.publish(message)
        self.bench.wait_for(lambda: len(self.modes) >= before + answers)
        assert len(self.modes) == before + answers
        return self.modes[-1]

    def show_frame(self, frame: np.ndarray, index: int) -> DiagnosticArray:
        answer = self.show(image_message(header(index), frame))
        assert answer.header == header(index)
        return answer

    def play(self, frames, first: int = 0) -> list[DiagnosticArray]:
        """Show frames with stamps in step."""
        return [self.show_frame(frame, first + index) for index, frame in enumerate(frames)]

    def said(self, index: int):
        """Wait for what was said of each vehicle in an image: {id: values}."""
        found = self.bench.wait_for(
            lambda: next((one for one in self.statuses if one.header == header(index)), None)
        )
        values = [{pair.key: pair.value for pair in one.values} for one in found.status]
        return {int(one["id"]): one for one in values}
