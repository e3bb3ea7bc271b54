# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Detections of all vehicles as messages, in and out, where vision_msgs is installed."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import Any

import numpy as np
from rclpy.serialization import deserialize_message
from std_msgs.msg import Header

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.detections import CLASS, detection_message, detections_type
from vehicle_pf_tracker.trackers.traffic.counting import CONFIRMED
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

_BODY = 4
"""Bytes before the message."""
_LONGEST = 1_000_000
"""Longest message in bytes that is read: 2300 detections, which take rclpy 0.3 s. Ten thousand
would take 1.5 s, in which no image is answered."""


def detections_message(header: Header, estimates: Iterable[TrackEstimate]) -> Any:
    """Make the detections of the vehicles that are seen or predicted, with their numbers."""
    found = [
        detection_message(header, one, str(one.identity), one.label or CLASS)
        for one in estimates
        if one.mode in CONFIRMED
    ]
    return detections_type()(header=header, detections=found)


def read_stamp(message: bytes) -> int:
    """Return the stamp in ns at the head of a serialized message.

    Raises
    ------
    InputError
        If it is cut off.
    """
    try:
        order = "<" if message[1] & 1 else ">"
        seconds, nanoseconds = struct.unpack_from(f"{order}iI", message, _BODY)
    except (struct.error, IndexError):
        raise InputError("a message of detections is cut off before its stamp") from None
    return int(seconds) * 1_000_000_000 + int(nanoseconds)


def read_serialized_detections(message: bytes) -> Detections:
    """Read a vision_msgs/Detection2DArray in CDR, its encapsulation header included.

    Raises
    ------
    InputError
        If it is too long to be read in time.
    """
    if len(message) > _LONGEST:
        raise InputError(
            f"a message of detections has {len(message) / 1e6:.1f} MB, more than the "
            f"{_LONGEST / 1e6:g} MB that are read; is the detector in order?"
        )
    return read_detections(deserialize_message(message, detections_type()))


def read_detections(message: Any) -> Detections:
    """Read a vision_msgs/Detection2DArray.

    A turned box becomes the upright one around it. Score and class are those of the hypothesis with
    the highest score; a detection without one has the score 1 and no class.
    """
    rows = [_row(one.bbox) for one in message.detections]
    best = [_best(one.results) for one in message.detections]
    boxes = np.array(rows, dtype=np.float64).reshape(-1, 5)
    with np.errstate(invalid="ignore", over="ignore"):
        x, y, width, height, theta = boxes.T
        cosine, sine = np.abs(np.cos(theta)), np.abs(np.sin(theta))
        # Negative sizes stay so: they are to be refused, and a turn could make them positive.
        is_turned = (theta != 0) & (width > 0) & (height > 0)
        across = np.where(is_turned, width * cosine + height * sine, width)
        down = np.where(is_turned, width * sine + height * cosine, height)
        upright = np.stack([x - across / 2, y - down / 2, across, down], axis=1)
    return Detections.make(upright, [score for score, _ in best], [label for _, label in best])


def _row(box: Any) -> tuple[float, float, float, float, float]:
    centre = box.center
    at = centre.position
    return at.x, at.y, box.size_x, box.size_y, centre.theta


def _best(results: Any) -> tuple[float, str]:
    if not results:
        return 1.0, ""
    best = max((one.hypothesis for one in results), key=lambda one: float(one.score))
    return float(best.score), str(best.class_id)
