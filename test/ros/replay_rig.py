# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Small recordings, and a stub of a tracker node that notes what happens to it."""

from __future__ import annotations

import threading
from contextlib import contextmanager

import cv2
import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rcl_interfaces.msg import SetParametersResult
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from std_srvs.srv import Trigger

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter

PERIOD_NS = 40_000_000
BEGIN_NS = 5_000_000_000
COUNT = 10
IMAGE_TOPIC = "/camera/image_raw"
COMMAND = (
    "-c",
    "import sys; from vehicle_pf_tracker.cli.main import bag_replay; sys.exit(bag_replay())",
)


def stamps(count=COUNT):
    return [BEGIN_NS + index * PERIOD_NS for index in range(count)]


def record(folder, stamps_ns=None, *, truth_from=0, compressed=False):
    """Record 32x24 images, with the truth x = 4 + index from image `truth_from` on."""
    with RecordingWriter(folder) as writer:
        for index, stamp in enumerate(stamps() if stamps_ns is None else stamps_ns):
            frame = np.full((24, 32, 3), (10 * index, 50, 200), np.uint8)
            if compressed:
                coded = cv2.imencode(".png", frame[..., ::-1])[1].tobytes()
                writer.write_compressed(stamp, "png", coded)
            else:
                writer.write_image(stamp, frame)
            if truth_from is not None and index >= truth_from:
                writer.write_truth(Truth(stamp, Box(4.0 + index, 5.5, 8.0, 6.0), Occlusion.NONE))
    return Recording(folder)


class StubTracker:
    """Answers each image; `events` holds what came in, in order.

    Parameters
    ----------
    mute_at
        Number of the image, from 1, that it does not answer.
    refuses_target
        Whether it rejects every target.
    log
        List to append (name, event) to, shared by several stubs.
    on_image
        Called with the number of each image.
    depth
        Images that may wait for it.
    """

    def __init__(
        self,
        bench,
        name="stub_tracker",
        topic=IMAGE_TOPIC,
        *,
        mute_at=None,
        refuses_target=False,
        log=None,
        on_image=None,
        depth=COUNT,
    ):
        self.name = name
        self.events, self.images = [], []
        self.mute_at, self.refuses_target = mute_at, refuses_target
        self.log, self.on_image = log if log is not None else [], on_image
        self.node = rclpy.create_node(name, context=bench.context)
        for key in ("x", "y", "width", "height"):
            self.node.declare_parameter(f"target.{key}", 0.0)
        self.node.add_on_set_parameters_callback(self.set)
        self.mode = self.node.create_publisher(DiagnosticArray, "~/mode", 10)
        self.node.create_service(Trigger, "~/reset", self.reset)
        qos = QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.node.create_subscription(Image, topic, self.take, qos)
        bench.add(self.node)

    @property
    def stamps(self):
        return [event for event in self.events if isinstance(event, int)]

    def note(self, event):
        self.events.append(event)
        self.log.append((self.name, event))

    def set(self, parameters):
        self.note(("set", *(parameter.value for parameter in parameters)))
        return SetParametersResult(successful=not self.refuses_target, reason="it is too big")

    def reset(self, _, response):
        self.note("reset")
        response.success = True
        return response

    def take(self, image):
        stamp = image.header.stamp.sec * 10**9 + image.header.stamp.nanosec
        self.images.append(image)
        self.note(stamp)
        if self.on_image is not None:
            self.on_image(len(self.images))
        if len(self.images) == self.mute_at:
            return
        values = [KeyValue(key="x", value=repr(0.1 + len(self.images)))]
        status = DiagnosticStatus(message="TRACKING", values=values)
        self.log.append((self.name, "answered"))
        self.mode.publish(DiagnosticArray(header=image.header, status=[status]))


@contextmanager
def spinning(bench):
    """Spin the bench in a thread, so that the test can replay meanwhile."""
    ended = threading.Event()

    def spin():
        while not ended.is_set():
            bench.executor.spin_once(timeout_sec=0.02)

    thread = threading.Thread(target=spin)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
