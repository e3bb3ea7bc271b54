# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import os
import signal
import time

import pytest

pytest.importorskip("rclpy")

import numpy as np
from geometry_msgs.msg import PointStamped
from replay_rig import BEGIN_NS, COUNT, IMAGE_TOPIC, StubTracker, record, spinning, stamps
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replaying import replay

pytestmark = pytest.mark.ros

SPAN = (stamps()[-1] - stamps()[0]) * 1e-9


def play(bench, recording, **options):
    """Replay to the stub on `bench` while the bench spins."""
    with spinning(bench):
        return replay(recording, ReplayOptions(**{"nodes": ("stub_tracker",), **options}))


@pytest.mark.parametrize("rate", [None, 0.5])
def test_a_recording_plays_at_its_own_pace_and_the_rate_divides_the_time(bench, tmp_path, rate):
    stub = StubTracker(bench)
    report = play(bench, record(tmp_path / "bag"), rate=rate)
    assert stub.stamps == stamps()
    assert report.nodes[0].answered == COUNT
    assert report.seconds >= SPAN / (rate or 1.0)


def test_lockstep_with_a_rate_is_no_faster(bench, tmp_path):
    StubTracker(bench)
    hours = [stamp + index * 3600 * 10**9 for index, stamp in enumerate(stamps())]
    assert play(bench, record(tmp_path / "bag", hours), lockstep=True).seconds < 3600
    assert play(bench, record(tmp_path / "bag2"), lockstep=True, rate=1.0).seconds >= SPAN


def test_unanswered_frames_keep_their_rows(bench, tmp_path):
    StubTracker(bench, mute_at=4)
    report = play(bench, record(tmp_path / "bag"), rate=4.0)
    (node,) = report.nodes
    assert (report.frames, node.answered) == (COUNT, COUNT - 1)
    assert [row.frame for row in node.rows] == list(range(1, COUNT + 1))
    assert [row.mode for row in node.rows].index("DROPPED") == 3
    assert node.rows[3].x is None
    (notice,) = report.notices
    assert notice.startswith("/stub_tracker did not answer 1 of 10 images: ")


def test_images_lost_to_a_busy_node_are_told_from_those_lost_on_the_way(bench, tmp_path):
    stub = StubTracker(bench, depth=1, on_image=lambda count: time.sleep(0.3 * (count == 1)))
    report = play(bench, record(tmp_path / "bag"), rate=1.0)
    lost = COUNT - len(stub.stamps)
    assert lost >= 4  # 0.3 s are 7 images, of which the last one waits
    (notice,) = report.notices
    assert f"did not answer {lost} of 10 images: " in notice
    assert "came while it was at work on an earlier one" in notice


def test_a_dropped_last_frame_is_waited_for_no_longer_than_the_timeout(bench, tmp_path):
    StubTracker(bench, mute_at=COUNT)
    report = play(bench, record(tmp_path / "bag"), rate=4.0, timeout=0.6)
    assert 0.6 <= report.seconds < 30
    assert report.nodes[0].rows[-1].mode == "DROPPED"


def test_a_part_is_played_with_its_own_first_truth(bench, tmp_path):
    stub = StubTracker(bench)
    report = play(
        bench, record(tmp_path / "bag"), lockstep=True, start_offset=0.08, playback_duration=0.16
    )
    assert stub.events == [("set", 6.0, 5.5, 8.0, 6.0), "reset", *stamps()[2:6]]
    assert [row.frame for row in report.nodes[0].rows] == [1, 2, 3, 4]


def test_a_part_without_images_is_refused(ros_domain, tmp_path):
    with pytest.raises(InputError, match=r"it lasts 0\.4 s"):
        replay(record(tmp_path / "bag"), ReplayOptions(start_offset=9.0))


def test_a_loop_begins_again_until_interrupted_twice(bench, tmp_path):
    def interrupt(count):
        if count >= 2 * COUNT + 3:
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    stub = StubTracker(bench, on_image=interrupt)
    report = play(bench, record(tmp_path / "bag"), lockstep=True, loop=True)
    assert stub.stamps[: 2 * COUNT + 3] == stamps() + stamps() + stamps()[:3]
    assert stub.events.count("reset") == 1
    assert report.interrupted
    assert report.frames >= 2 * COUNT + 3
    assert len(report.nodes[0].rows) == report.frames - 2 * COUNT
    assert signal.getsignal(signal.SIGINT) is before


def test_a_loop_with_late_truth_waits_for_it_in_each_pass(bench, tmp_path):
    def interrupt(count):
        if count == 2 * COUNT:
            os.kill(os.getpid(), signal.SIGINT)

    stub = StubTracker(bench, on_image=interrupt)
    play(bench, record(tmp_path / "bag", truth_from=2), lockstep=True, loop=True)
    none, box = ("set", 0.0, 0.0, 0.0, 0.0), ("set", 6.0, 5.5, 8.0, 6.0)
    one_pass = [none, "reset", *stamps()[:2], box, *stamps()[2:]]
    assert stub.events[: 2 * len(one_pass)] == 2 * one_pass


def test_topics_are_renamed(bench, tmp_path):
    stub = StubTracker(bench, topic="/front/image")
    report = play(
        bench, record(tmp_path / "bag"), lockstep=True, remap={IMAGE_TOPIC: "/front/image"}
    )
    assert stub.stamps == stamps()
    assert report.nodes[0].answered == COUNT


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"remap": {"/camera": "/x"}}, "has no topic /camera; it has /camera/image_raw"),
        ({"topics": ("/nothing",)}, "has no topic /nothing"),
        ({"remap": {IMAGE_TOPIC: "/a b"}}, "'/a b' is not a topic name"),
        ({"remap": {IMAGE_TOPIC: "/ground_truth/box"}}, "published as /ground_truth/box"),
        ({"ros_args": ("-r", "nonsense")}, "after --ros-args are not understood"),
    ],
)
def test_names_that_do_not_fit_are_told(ros_domain, tmp_path, options, words):
    with pytest.raises(InputError, match=words):
        replay(record(tmp_path / "bag"), ReplayOptions(**options))


def test_other_topics_go_out_as_they_were_recorded(bench, tmp_path):
    StubTracker(bench)
    received = bench.collect(PointStamped, "/ground_truth/position", count=0)
    play(bench, record(tmp_path / "bag"))
    bench.wait_for(lambda: len(received) == COUNT)
    assert [message.point.x for message in received] == [8.0 + index for index in range(COUNT)]
    assert [message.point.y for message in received] == [8.5] * COUNT


@pytest.mark.parametrize("options", [{"lockstep": True}, {"rate": 0.5}])
def test_the_clock_follows_the_recording(bench, tmp_path, options):
    StubTracker(bench)
    received = bench.collect(Clock, "/clock", count=0)
    play(bench, record(tmp_path / "bag"), clock=100.0, **options)
    times = [message.clock.sec * 10**9 + message.clock.nanosec for message in received]
    assert times == sorted(times)
    assert len(set(times)) >= COUNT
    assert times[0] >= BEGIN_NS
    assert times[-1] <= stamps()[-1]


def test_playing_begins_when_somebody_subscribes(bench, tmp_path):
    stubs, told = [], []

    def tell(sentence):
        told.append(sentence)
        stubs.append(StubTracker(bench))

    options = ReplayOptions(wait_for_subscribers=True, lockstep=True)
    with spinning(bench):
        report = replay(record(tmp_path / "bag"), options, tell=tell)
    assert told == [f"waiting for a subscriber of {IMAGE_TOPIC}"]
    assert stubs[0].stamps == stamps()
    assert report.nodes[0].answered == COUNT


def test_compressed_images_go_out_raw(bench, tmp_path):
    stub = StubTracker(bench)
    report = play(bench, record(tmp_path / "bag", compressed=True), lockstep=True, decompress=True)
    assert report.nodes[0].answered == COUNT
    image: Image = stub.images[3]
    assert (image.encoding, image.width, image.height, image.step) == ("rgb8", 32, 24, 96)
    assert image.header.frame_id == "camera"
    pixels = np.frombuffer(image.data, np.uint8).reshape(24, 32, 3)
    assert (pixels == (30, 50, 200)).all()


def test_without_nodes_it_plays_for_whoever_listens(ros_domain, tmp_path):
    told = []
    report = replay(
        record(tmp_path / "bag", truth_from=None), ReplayOptions(rate=10.0), tell=told.append
    )
    assert (report.frames, report.nodes) == (COUNT, ())
    assert told == [f"no tracker node subscribes to {IMAGE_TOPIC}: is one running and active?"]
