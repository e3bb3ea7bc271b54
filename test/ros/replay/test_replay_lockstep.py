# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

pytest.importorskip("rclpy")

from replay_rig import IMAGE_TOPIC, StubTracker, record, spinning, stamps

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replaying import replay
from vehicle_pf_tracker.ros.replay.starting_target import NoTargetError

pytestmark = pytest.mark.ros

FIRST_BOX = ("set", 4.0, 5.5, 8.0, 6.0)
NO_BOX = ("set", 0.0, 0.0, 0.0, 0.0)


def lockstep(*nodes, **options):
    return ReplayOptions(lockstep=True, nodes=nodes or ("stub_tracker",), **options)


def test_every_frame_is_answered_in_order_after_target_and_reset(bench, tmp_path):
    stub = StubTracker(bench)
    with spinning(bench):
        report = replay(record(tmp_path / "bag"), lockstep())
    assert stub.events == [FIRST_BOX, "reset", *stamps()]
    assert report.frames == 10
    (node,) = report.nodes
    assert (node.name, node.answered) == ("/stub_tracker", 10)
    assert [(row.frame, row.stamp_ns) for row in node.rows] == list(enumerate(stamps(), start=1))
    assert [row.x for row in node.rows] == [0.1 + count for count in range(1, 11)]


def test_the_next_frame_waits_for_the_slowest_node(bench, tmp_path):
    log = []
    StubTracker(bench, "a_tracker", log=log)
    StubTracker(bench, "b_tracker", log=log)
    with spinning(bench):
        report = replay(record(tmp_path / "bag"), lockstep("a_tracker", "/b_tracker"))
    assert [node.answered for node in report.nodes] == [10, 10]
    images = [event for event in log if isinstance(event[1], int)]
    for before, after in zip(images[1::2], images[2::2], strict=False):
        answers = (
            log[: log.index(after)].count(("a_tracker", "answered")),
            log[: log.index(after)].count(("b_tracker", "answered")),
        )
        frame = stamps().index(before[1]) + 1
        assert answers == (frame, frame)


def test_truth_that_begins_later_is_set_right_before_its_frame(bench, tmp_path):
    stub = StubTracker(bench)
    with spinning(bench):
        replay(record(tmp_path / "bag", truth_from=3), lockstep())
    late = ("set", 7.0, 5.5, 8.0, 6.0)
    assert stub.events == [NO_BOX, "reset", *stamps()[:3], late, *stamps()[3:]]


def test_a_given_target_goes_before_the_truth(bench, tmp_path):
    stub = StubTracker(bench)
    with spinning(bench):
        replay(record(tmp_path / "bag", truth_from=3), lockstep(target=Box(1, 2, 3.5, 4)))
    assert stub.events[:2] == [("set", 1.0, 2.0, 3.5, 4.0), "reset"]
    assert stub.events[2:] == stamps()


def test_targets_can_be_left_alone(bench, tmp_path):
    stub = StubTracker(bench)
    with spinning(bench):
        replay(record(tmp_path / "bag", truth_from=None), lockstep(set_target=False))
    assert stub.events == stamps()


def test_nodes_without_a_target_are_refused(bench, tmp_path):
    stub = StubTracker(bench)
    with spinning(bench), pytest.raises(NoTargetError, match="--target x,y,w,h"):
        replay(record(tmp_path / "bag", truth_from=None), lockstep())
    assert stub.events == []


def test_a_refused_target_is_told_with_its_reason(bench, tmp_path):
    StubTracker(bench, refuses_target=True)
    with spinning(bench), pytest.raises(InputError, match=r"4,5\.5,8,6: it is too big"):
        replay(record(tmp_path / "bag"), lockstep())


def test_a_missing_answer_names_node_and_frame(bench, tmp_path):
    stub = StubTracker(bench, mute_at=3)
    message = r"/stub_tracker did not answer frame 3 \(stamp 5080000000 ns\) within 0.5 s"
    with spinning(bench), pytest.raises(InputError, match=message):
        replay(record(tmp_path / "bag"), lockstep(timeout=0.5, set_target=False))
    assert stub.stamps == stamps()[:3]


def test_equal_stamps_are_answered_one_by_one(bench, tmp_path):
    stub = StubTracker(bench)
    repeated = [stamps()[0], *stamps()[:3], stamps()[2]]
    with spinning(bench):
        report = replay(record(tmp_path / "bag", repeated, truth_from=1), lockstep())
    assert stub.stamps == repeated
    assert [row.stamp_ns for row in report.nodes[0].rows] == repeated
    assert report.nodes[0].answered == 5


def test_nodes_are_found_by_themselves(bench, tmp_path):
    StubTracker(bench, "a_tracker")
    StubTracker(bench, "b_tracker")
    StubTracker(bench, "elsewhere_tracker", topic="/other")
    with spinning(bench):
        report = replay(record(tmp_path / "bag"), ReplayOptions(lockstep=True))
    assert [node.name for node in report.nodes] == ["/a_tracker", "/b_tracker"]


def test_a_node_on_another_topic_is_told_with_that_topic(bench, tmp_path):
    StubTracker(bench, topic="/other")
    message = f"does not subscribe to {IMAGE_TOPIC} .* takes images from /other; use --remap"
    with spinning(bench), pytest.raises(InputError, match=message):
        replay(record(tmp_path / "bag"), lockstep(timeout=5.0))


def test_a_node_of_the_other_transport_is_told_which_one_to_take(bench, tmp_path):
    StubTracker(bench)
    message = f"takes images from {IMAGE_TOPIC}; start it .* image_transport:=compressed"
    with spinning(bench), pytest.raises(InputError, match=message):
        replay(record(tmp_path / "bag", compressed=True), lockstep(timeout=5.0))


def test_lockstep_without_nodes_is_refused(ros_domain, tmp_path):
    with pytest.raises(InputError, match=f"no tracker node subscribes to {IMAGE_TOPIC}"):
        replay(record(tmp_path / "bag"), ReplayOptions(lockstep=True, timeout=0.5))


def test_lockstep_without_images_is_refused(bench, tmp_path):
    recording = record(tmp_path / "bag")
    with pytest.raises(InputError, match="add it to --topics"):
        replay(recording, lockstep(topics=("/ground_truth/box",)))
