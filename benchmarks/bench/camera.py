# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The process that publishes images to the nodes that are measured, and hears their answers."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from benchmarks.bench.material import FRAME_RATE, drive
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.transport import image_transport

_TIMEOUT = 20.0
"""Longest wait for a node, s: a cold start that compiles has ended before."""
_COLD_TIMEOUT = 120.0
"""Longest wait for the answer of a node that has to compile, s: ten times what it took here."""
_DEPTH = 10
"""Images kept for a slow node, ROS's usual depth: what is lost then is lost for users too."""
_HEARD = 1000
"""Answers that may wait here: none is lost on this side, or it would count against the node."""
_SETTLE = 2.0
"""Time that late answers have after the last image, s: far longer than a step. A choice."""
_PERIOD_NS = round(1e9 / FRAME_RATE)
"""Distance of the images' stamps, ns."""


class Camera:
    """Shows the drive to nodes, each with an image topic of its own; a context manager.

    Parameters
    ----------
    nodes : dict of str to str
        Position topic of each node, by its image topic.
    """

    def __init__(self, nodes: dict[str, str]) -> None:
        self._context = Context()
        # Shared memory for the images of all nodes; see `image_transport`.
        bytes_of_one = drive().frames[0].nbytes * len(nodes)
        middleware = rclpy.get_rmw_implementation_identifier()
        with image_transport(bytes_of_one, middleware):
            self._context.init()
            self._node = rclpy.create_node("camera", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._images = {
            topic: self._node.create_publisher(Image, topic, QoSProfile(depth=_DEPTH))
            for topic in nodes
        }
        self.answered = dict.fromkeys(nodes, 0)
        for topic, position in nodes.items():
            self._node.create_subscription(
                PointStamped,
                position,
                lambda _, topic=topic: self._heard(topic),
                QoSProfile(depth=_HEARD),
            )
        # Made before: what a message costs to build is not the node's.
        there = [image_message(_header(0), frame) for frame in drive().frames]
        self._shown = there + there[-2:0:-1]  # and back, since a vehicle does not jump
        self.sent = dict.fromkeys(nodes, 0)

    def hear(self, outputs: Mapping[str, type[Any]]) -> None:
        """Listen to more topics, by their types, and do nothing with what comes."""
        for topic, kind in outputs.items():
            self._node.create_subscription(kind, topic, lambda _: None, QoSProfile(depth=_DEPTH))

    def wait(self) -> None:
        """Wait until every node listens, and has answered an image.

        Raises
        ------
        InputError
            If one does not.
        """
        # Shown again and again: until discovery is over, images are lost on the way.
        deadline = time.monotonic() + _TIMEOUT
        for topic in self._images:
            while not self.answered[topic]:
                if time.monotonic() > deadline:
                    raise InputError(f"the node on {topic} answers no image")
                self.show(topic)
                self.listen(0.1)
        # The answers to repeated images, which would be taken for those of the next ones.
        self.listen(0.5)

    def first_answer(self, topic: str) -> float:
        """Show images at the camera's rate until one is answered; steady time of the answer, s.

        Raises
        ------
        InputError
            If none is.
        """
        deadline = time.monotonic() + _COLD_TIMEOUT
        while not self.answered[topic]:
            due = time.monotonic() + 1 / FRAME_RATE
            if due > deadline:
                raise InputError(f"the node on {topic} answers no image")
            self.show(topic)
            while not self.answered[topic] and (left := due - time.monotonic()) > 0:
                self._executor.spin_once(timeout_sec=left)
        return time.monotonic()

    def show(self, topic: str) -> None:
        """Publish the next image of the drive there and back."""
        number = self.sent[topic]
        message = self._shown[number % len(self._shown)]
        message.header = _header(number)
        self.sent[topic] += 1
        self._images[topic].publish(message)

    def listen(self, seconds: float) -> None:
        """Take answers for this long."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def batch(self, topic: str, count: int, rate: float) -> None:
        """Show `count` images at `rate` per second, each after the answer to the one before.

        Raises
        ------
        InputError
            If an answer does not come.
        """
        for _ in range(count):
            # At a camera's rate and not faster: caches are cold between two images, as in use.
            due = time.monotonic() + 1 / rate
            wanted = self.answered[topic] + 1
            self.show(topic)
            while self.answered[topic] < wanted:
                if time.monotonic() > due + _TIMEOUT:
                    raise InputError(f"the node on {topic} did not answer an image")
                self._executor.spin_once(timeout_sec=0.1)
            self.listen(due - time.monotonic())

    def stream(self, seconds: float, rate: float) -> None:
        """Show every node `rate` images per second, spread over the period, without waiting."""
        topics = list(self._images)
        began = time.monotonic()
        # Spread over the period: cameras are not synchronised.
        for number in range(round(seconds * rate) * len(topics)):
            self.listen(began + number / (rate * len(topics)) - time.monotonic())
            self.show(topics[number % len(topics)])
        # Late answers still count: only what never comes is lost.
        self.listen(_SETTLE)

    def __enter__(self) -> Camera:
        return self

    def __exit__(self, *failure: object) -> None:
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _heard(self, topic: str) -> None:
        self.answered[topic] += 1


def _header(number: int) -> Header:
    # Increasing stamps, from 1 s on: a stamp of 0 means "none" to many tools.
    header = Header(frame_id="camera")
    header.stamp.sec, header.stamp.nanosec = divmod(10**9 + number * _PERIOD_NS, 10**9)
    return header
