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

"""vision_msgs/Detection2D, where that package is installed: the target in, the estimate out."""

from __future__ import annotations

from typing import Any, Protocol

from std_msgs.msg import Header

from vehicle_pf_tracker.ros.messages import Located

try:
    from vision_msgs.msg import Detection2D, Detection2DArray, ObjectHypothesisWithPose
except ImportError:  # an optional package: the nodes work without its topics
    Detection2D = Detection2DArray = ObjectHypothesisWithPose = None

CLASS = "vehicle"
"""Class of a detection that goes out."""


class Judged(Located, Protocol):
    """Estimate with a confidence."""

    @property
    def confidence(self) -> float:
        """From 0 to 1."""
        ...


def detection_type() -> Any:
    """Return the message type; None where vision_msgs is not installed."""
    return Detection2D


def detections_type() -> Any:
    """Return the message type of several; None where vision_msgs is not installed."""
    return Detection2DArray


def detection_message(header: Header, estimate: Judged, identity: str, label: str = CLASS) -> Any:
    """Make the detection: box in px, confidence as score, class, and the id of the track."""
    message = Detection2D(header=header, id=identity)
    x, y = estimate.box.centre
    message.bbox.center.position.x, message.bbox.center.position.y = float(x), float(y)
    message.bbox.size_x = float(estimate.box.width)
    message.bbox.size_y = float(estimate.box.height)
    result = ObjectHypothesisWithPose()
    result.hypothesis.class_id = label
    result.hypothesis.score = float(estimate.confidence)
    message.results = [result]
    return message
