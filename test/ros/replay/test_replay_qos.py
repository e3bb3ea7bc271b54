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

"""The QoS that a replay offers, and the topics that it plays."""

import pytest

pytest.importorskip("rclpy")

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, ReliabilityPolicy
from replay_rig import IMAGE_TOPIC, record

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.replay.publishing import make_publishers
from vehicle_pf_tracker.ros.replay.replay_options import (
    ReplayOptions,
    read_qos_overrides,
    recorded_qos,
)

pytestmark = pytest.mark.ros

LATCHED = "- {history: keep_last, depth: 3, reliability: reliable, durability: transient_local}\n"
OLD = "- history: 1\n  depth: 2\n  reliability: 1\n  durability: 1\n"
SENSOR = "- {history: keep_last, depth: 5, reliability: best_effort, durability: volatile}\n"


@pytest.mark.parametrize(("text", "depth"), [(LATCHED, 3), (OLD, 2), (LATCHED + OLD, 3)])
def test_latched_topics_stay_latched(text, depth):
    qos = recorded_qos(text, 100)
    assert qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert qos.reliability == ReliabilityPolicy.RELIABLE
    assert (qos.history, qos.depth) == (HistoryPolicy.KEEP_LAST, depth)


def test_a_topic_that_keeps_all_keeps_all():
    assert (
        recorded_qos(LATCHED.replace("keep_last", "keep_all"), 100).history
        == HistoryPolicy.KEEP_ALL
    )


@pytest.mark.parametrize(
    "text", ["", SENSOR, LATCHED + SENSOR, "[", "[" * 99_999, "a: b", "- 5", "- {durability: 7}"]
)
def test_others_are_reliable_and_volatile(text):
    qos = recorded_qos(text, 42)
    assert qos.durability != DurabilityPolicy.TRANSIENT_LOCAL
    assert qos.reliability == ReliabilityPolicy.RELIABLE
    assert qos.depth == 42


def test_a_depth_that_nobody_means_is_passed_over():
    assert recorded_qos(LATCHED.replace("3", "99999999999"), 100).depth == 1


def test_the_file_of_rosbag2_is_read(tmp_path):
    path = tmp_path / "qos.yaml"
    path.write_text(
        "/tf_static:\n  history: keep_all\n  durability: transient_local\n"
        "/camera:\n  depth: 2\n  reliability: best_effort\n"
        "  deadline: {sec: 1, nsec: 500000000}\n  liveliness: automatic\n"
        "  liveliness_lease_duration: {sec: 3}\n  lifespan: {nsec: 7}\n"
        "  avoid_ros_namespace_conventions: false\n"
    )
    found = read_qos_overrides(path)
    assert found["/tf_static"].history == HistoryPolicy.KEEP_ALL
    assert found["/tf_static"].durability == DurabilityPolicy.TRANSIENT_LOCAL
    camera = found["/camera"]
    assert (camera.depth, camera.reliability) == (2, ReliabilityPolicy.BEST_EFFORT)
    assert camera.deadline == Duration(seconds=1.5)
    assert camera.liveliness == LivelinessPolicy.AUTOMATIC


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("5", "does not name topics"),
        ("/a: latched", "is not a profile"),
        ("/a: {durability: forever}", "durability must be one of"),
        ("/a: {depth: 0}", "depth: 0 is not understood"),
        ("/a: {deadline: 5}", "deadline: 5 is not understood"),
        ("/a: {deadline: {sec: x}}", "QoS file"),
        ("/a: {durabilty: volatile}", "durabilty"),
        ("/a: {depth: 1, depth: 2}", "there twice"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path, text, said):
    (tmp_path / "qos.yaml").write_text(text)
    with pytest.raises(InputError, match=said):
        read_qos_overrides(tmp_path / "qos.yaml")


def played(bench, recording, **options):
    publishers, _ = make_publishers(bench.node, recording, ReplayOptions(**options))
    return sorted(publishers)


def test_topics_are_chosen_by_name_and_by_pattern(bench, tmp_path):
    recording = record(tmp_path / "bag")
    everything = sorted(topic.name for topic in recording.topics)
    truth = [name for name in everything if name != IMAGE_TOPIC]
    assert played(bench, recording) == everything
    assert played(bench, recording, regex="/ground_truth/.*") == truth
    assert played(bench, recording, regex="ground_truth") == []
    assert played(bench, recording, exclude=(IMAGE_TOPIC,)) == truth
    assert played(bench, recording, exclude_regex="/ground_truth/.*") == [IMAGE_TOPIC]
    assert played(bench, recording, topics=(IMAGE_TOPIC,), exclude_regex=".*raw") == []
    with pytest.raises(InputError, match="has no topic /nothing"):
        played(bench, recording, exclude=("/nothing",))


def test_an_override_is_by_the_recorded_name(bench, tmp_path):
    recording = record(tmp_path / "bag")
    (tmp_path / "qos.yaml").write_text(f"{IMAGE_TOPIC}: {{depth: 7, reliability: best_effort}}")
    options = ReplayOptions(
        qos=read_qos_overrides(tmp_path / "qos.yaml"), remap={IMAGE_TOPIC: "/front/image"}
    )
    make_publishers(bench.node, recording, options)
    (info,) = bench.node.get_publishers_info_by_topic("/front/image")
    assert info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT


def test_a_pattern_that_is_none_is_a_usage_error(tmp_path, capsys):
    assert main(["replay", str(tmp_path), "--regex", "["]) == 2
    assert "'[' is not a pattern" in capsys.readouterr().err
