# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The QoS that a replay offers, and the topics that it plays."""

import pytest

pytest.importorskip("rclpy")

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from replay_rig import IMAGE_TOPIC, record

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.replay.publishing import make_publishers
from vehicle_pf_tracker.ros.replay.recorded_qos import recorded_qos
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions

pytestmark = pytest.mark.ros

LATCHED = "- {history: keep_last, depth: 3, reliability: reliable, durability: transient_local}\n"
OLD = "- history: 1\n  depth: 2\n  reliability: 1\n  durability: 1\n"
SENSOR = "- {history: keep_last, depth: 5, reliability: best_effort, durability: volatile}\n"


@pytest.mark.parametrize("text", [LATCHED, OLD, LATCHED + OLD])
def test_latched_topics_stay_latched(text):
    qos = recorded_qos(text, 100)
    assert qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert qos.reliability == ReliabilityPolicy.RELIABLE
    assert qos.depth == 100


@pytest.mark.parametrize(
    "text", ["", SENSOR, LATCHED + SENSOR, "[", "[" * 99_999, "a: b", "- 5", "- {durability: 7}"]
)
def test_others_are_reliable_and_volatile(text):
    qos = recorded_qos(text, 42)
    assert qos.durability != DurabilityPolicy.TRANSIENT_LOCAL
    assert qos.reliability == ReliabilityPolicy.RELIABLE
    assert qos.depth == 42


def played(bench, recording, **options):
    publishers, _ = make_publishers(bench.node, recording, ReplayOptions(**options))
    return sorted(publishers)


def test_topics_are_chosen_by_name(bench, tmp_path):
    recording = record(tmp_path / "bag")
    everything = sorted(topic.name for topic in recording.topics)
    truth = [name for name in everything if name != IMAGE_TOPIC]
    assert played(bench, recording) == everything
    assert played(bench, recording, topics=truth) == truth
    with pytest.raises(InputError, match="has no topic /nothing"):
        played(bench, recording, topics=("/nothing",))
