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

"""Detections in and out, with a stand-in that has the fields of vision_msgs/Detection2D.

The package is no wheel, so nothing is sent here; test_node_optional_messages.py builds it and does.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from std_msgs.msg import Header
from tracker_rig import Rig, on_target

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import NodeParameters
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.ros import messages
from vehicle_pf_tracker.ros.node.input_messages import box_of_detection
from vehicle_pf_tracker.ros.node.outputs import TrackerOutputs
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.localisation import Localisation

pytestmark = pytest.mark.ros


def estimate(centre=(100.0, 80.0), *, size=(20.0, 10.0), regime="clear", confidence=1.0):
    particles, weights = np.array([centre]), np.ones(1)
    return Estimate(
        centre, Box.around(centre, *size), (0.0, 0.0), Mode.TRACKING, regime, confidence, {}, 1.0,
        0, 0, particles, weights,
    )  # fmt: skip


@dataclass
class Point2D:
    x: float = 0.0
    y: float = 0.0


@dataclass
class Pose2D:
    position: Point2D = field(default_factory=Point2D)
    theta: float = 0.0


@dataclass
class BoundingBox2D:
    center: Pose2D = field(default_factory=Pose2D)
    size_x: float = 0.0
    size_y: float = 0.0


@dataclass
class ObjectHypothesis:
    class_id: str = ""
    score: float = 0.0


@dataclass
class ObjectHypothesisWithPose:
    hypothesis: ObjectHypothesis = field(default_factory=ObjectHypothesis)
    pose: Any = None


@dataclass
class Detection2D:
    header: Header = field(default_factory=Header)
    results: list[ObjectHypothesisWithPose] = field(default_factory=list)
    bbox: BoundingBox2D = field(default_factory=BoundingBox2D)
    id: str = ""


@pytest.fixture
def stand_in(monkeypatch):
    monkeypatch.setattr(messages, "Detection2D", Detection2D)
    monkeypatch.setattr(messages, "ObjectHypothesisWithPose", ObjectHypothesisWithPose)


def detection(x=40.0, y=60.0, width=24.0, height=18.0, *, frame_id="", theta=0.0):
    box = BoundingBox2D(Pose2D(Point2D(x, y), theta), width, height)
    return Detection2D(Header(frame_id=frame_id), [], box)


def test_an_estimate_becomes_a_detection(stand_in):
    header = Header(frame_id="camera")
    one = estimate((100.0, 80.0), size=(20.0, 10.0), confidence=0.75)
    message = messages.detection_message(header, one, "3")
    assert (message.header, message.id) == (header, "3")
    assert message.bbox == BoundingBox2D(Pose2D(Point2D(100.0, 80.0)), 20.0, 10.0)
    (result,) = message.results
    assert result.hypothesis == ObjectHypothesis("vehicle", 0.75)


def test_a_detection_names_a_target():
    assert box_of_detection(detection()) == Box(28.0, 51.0, 24.0, 18.0)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (detection(x=float("nan")), "not finite"),
        (detection(theta=0.3), "upright"),
    ],
)
def test_detections_that_name_none(message, words):
    with pytest.raises(InputError, match=words):
        box_of_detection(message)


class FakeNode:
    """Hands out publishers that keep what they are given."""

    def __init__(self):
        self.sent = {}

    def get_name(self):
        return "fake"

    def create_lifecycle_publisher(self, kind, topic, qos):
        kept = self.sent.setdefault(topic, [])

        class Publisher:
            def get_subscription_count(self):
                return int(topic == "~/detection")

            def publish(self, message):
                assert isinstance(message, kind)
                kept.append(message)

        return Publisher()


def test_every_start_has_an_id_of_its_own(stand_in):
    node = FakeNode()
    outputs = TrackerOutputs(node, "camera")
    local, own = Localisation("pf", RoadParameters()), NodeParameters()
    for regime in ("start", "clear", "start"):
        outputs.publish_estimate(Header(), estimate(regime=regime), own, local, 1.0)
    assert [message.id for message in node.sent["~/detection"]] == ["1", "1", "2"]
    assert node.sent["~/pose_with_covariance"] == []


def test_without_the_package_there_are_no_such_topics(bench, monkeypatch):
    monkeypatch.setattr(messages, "Detection2D", None)
    rig = Rig(bench, on_target())
    names = {name for name, _ in rig.node.get_topic_names_and_types()}
    assert not {name for name in names if "detection" in name}
