# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A detector of vehicles that fails in one way or another."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Any

import numpy as np
from rclpy.serialization import serialize_message
from std_msgs.msg import Header

from laboratory.faults.node_process import Tester
from vehicle_pf_tracker.core.array import Array

LOW_SCORE = 0.05
"""Score of a flood's boxes: that of what a detector gives without a threshold."""
STAMP_OFFSET = 4
"""Byte at which the stamp is in a serialized message."""
NAN = math.nan
HUGE = 1e300
"""Coordinate whose square overflows."""
# Boxes that no detector should send; none may harm those beside it in a message.
UNUSABLE = {
    "NaN": (NAN, 5.0, 9.0, 9.0),
    "infinite size": (5.0, 5.0, math.inf, 9.0),
    "negative size": (40.0, 40.0, -20.0, -10.0),
    "no area": (5.0, 5.0, 0.0, 0.0),
    "outside": (5e3, 5.0, 9.0, 9.0),
    "huge": (-HUGE, 5.0, HUGE, 9.0),
}

Fault = Callable[[Header, Array], object]


class Detector:
    """Publishes boxes, right ones and faulty ones.

    Parameters
    ----------
    tester : Tester
        Publishes them.
    messages : module
        vision_msgs.msg.
    rate : int
        Images per second; a flood comes with one of them.

    Attributes
    ----------
    faults : dict of str to Fault
        Ways to fail; each is called with an image's header and the right boxes.
    """

    def __init__(self, tester: Tester, messages: Any, rate: int) -> None:
        self._messages = messages
        self._rate = rate
        self._turn = 0
        self._topic = tester.publisher(messages.Detection2DArray, "detections")
        self.faults: dict[str, Fault] = {
            "10 000 boxes, once a second": self._flood(10_000),
            "1 500 boxes, once a second": self._flood(1_500),
            **{words: self._bad(row) for words, row in UNUSABLE.items()},
            "each box five times": lambda header, boxes: self.right(header, np.tile(boxes, (5, 1))),
            "stamps that never match": self._stray,
            "no detections any more": lambda header, boxes: None,
        }

    def right(self, header: Header, boxes: Array) -> None:
        """Publish boxes (left, top, width, height) of an image."""
        self._topic.publish(self.message(header, boxes))

    def _flood(self, count: int) -> Fault:
        rows = np.random.default_rng(3).uniform(0, 150, (count, 4))
        # Serialized once, and only stamped anew: so many boxes take Python long to build.
        serialized = bytearray(serialize_message(self.message(Header(), rows, LOW_SCORE)))

        def flood(header: Header, boxes: Array) -> None:
            stamp = header.stamp
            self._turn += 1
            # Once a second; with every other image the detector is as it should be.
            if self._turn % self._rate:
                self.right(header, boxes)
                return
            # The stamp follows the four bytes that say how a message is encoded.
            struct.pack_into("<iI", serialized, STAMP_OFFSET, stamp.sec, stamp.nanosec)
            self._topic.publish(bytes(serialized))

        return flood

    def _bad(self, row: tuple[float, float, float, float]) -> Fault:
        return lambda header, boxes: self.right(header, np.concatenate([boxes, [row]]))

    def _stray(self, header: Header, boxes: Array) -> None:
        other = Header(frame_id=header.frame_id)
        other.stamp.sec = header.stamp.sec
        # A nanosecond beside: near enough for the eye, and never equal.
        other.stamp.nanosec = header.stamp.nanosec ^ 1
        self.right(other, boxes)

    def message(self, header: Header, boxes: Array, score: float = 0.8) -> Any:
        """Make detections (left, top, width, height)."""
        made = self._messages.Detection2DArray(header=header)
        for x, y, width, height in boxes.tolist():
            detection = self._messages.Detection2D()
            detection.bbox.center.position.x = x + width / 2
            detection.bbox.center.position.y = y + height / 2
            detection.bbox.size_x = width
            detection.bbox.size_y = height
            result = self._messages.ObjectHypothesisWithPose()
            result.hypothesis.class_id = "car"
            result.hypothesis.score = score
            detection.results = [result]
            made.detections.append(detection)
        return made
