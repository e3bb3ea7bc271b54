# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The node in a process of its own, a lock-step replay, and the command line: the same vehicles."""

from __future__ import annotations

import csv
import signal

import cv2
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.srv import GetState
from rclpy.qos import QoSProfile
from replay_rig import COMMAND, IMAGE_TOPIC
from tracker_rig import FIRST_NS, PERIOD_NS
from traffic_rig import NODE, WARM_UP, boxes, lanes

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.results.estimates import read_estimates
from vehicle_pf_tracker.ros.messages import stamp_ns

pytestmark = pytest.mark.ros

FRAMES = WARM_UP + 30
COLUMNS = ("id", "x", "y", "width", "height", "mode", "confidence")


def record(folder, *, compressed):
    with RecordingWriter(folder) as writer:
        for index, frame in enumerate(lanes(FRAMES)):
            stamp = FIRST_NS + index * PERIOD_NS
            if compressed:
                coded = cv2.imencode(".jpg", frame[..., ::-1])[1].tobytes()
                writer.write_compressed(stamp, "jpeg", coded)
            else:
                writer.write_image(stamp, frame)
    return folder


def offline(recording, out, *words):
    """Rows of tracks.csv as the command line writes them."""
    assert main(["traffic", str(recording), *words, "-o", str(out)]) == 0
    with (out / "tracks.csv").open() as file:
        return [(int(row["stamp_ns"]), *map(row.get, COLUMNS)) for row in csv.DictReader(file)]


def online(messages):
    rows = []
    for message in messages:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            rows.append((stamp_ns(message.header), *map(values.get, COLUMNS)))
    return rows


def in_numbers(rows):
    return [
        (stamp, int(number), *map(float, box), mode, float(confidence))
        for stamp, number, *box, mode, confidence in rows
        if mode != "TENTATIVE"  # of which the file has those that were confirmed later
    ]


@pytest.mark.parametrize(
    ("compressed", "by_hand"),
    [
        pytest.param(False, False, id="motion"),
        pytest.param(True, False, id="compressed", marks=pytest.mark.slow),
        pytest.param(False, True, id="by hand", marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_lockstep_and_offline_runs_give_identical_vehicles(
    start_node, start_process, bench, tmp_path, compressed, by_hand
):
    recording = record(tmp_path / "bag", compressed=compressed)
    target = ",".join(map(str, boxes(WARM_UP + 8)[0]))
    node = start_node(
        "traffic", "-r", f"image:={IMAGE_TOPIC}",
        "-p", f"image_transport:={'compressed' if compressed else 'raw'}",
        "-p", f"detector.kind:={'none' if by_hand else 'motion'}",
    )  # fmt: skip
    node.wait_for_output("ready")
    heard = bench.collect(DiagnosticArray, f"{NODE}/modes", QoSProfile(depth=1000))
    words = ["--target", target] if by_hand else ["--no-target"]
    replay = start_process(
        *COMMAND, str(recording), *words, "--lockstep", "--node", "traffic_tracker",
        "--timeout", "20", "-o", str(tmp_path / "replayed"),
    )  # fmt: skip
    bench.wait_for(lambda: len(heard) == FRAMES)
    assert replay.wait() == 0, replay.output
    assert f"/traffic_tracker: {FRAMES} answered, 0 not" in replay.output
    words = ["--detector", "none", "--target", f"@1:{target}"] if by_hand else []
    expected = offline(recording, tmp_path / "out", *words)
    assert len(in_numbers(expected)) > FRAMES / 2
    assert in_numbers(online(heard)) == in_numbers(expected)
    first, *others = read_estimates(tmp_path / "replayed" / "estimates.csv")
    assert first.mode == "WAITING"
    if by_hand:  # the target of the replay is the selected vehicle
        selected = [(row.stamp_ns, 1, row.x, row.y, row.width, row.height) for row in others]
        assert selected == [row[:6] for row in in_numbers(expected)]
    else:
        assert {row.mode for row in others} == {"WAITING"}


def test_the_executable_ends_with_a_signal_and_says_a_mistake_in_one_sentence(start_node, bench):
    node = start_node("traffic")
    node.wait_for_output("ready: images on /image (raw, best effort, keep last 1)")
    state = bench.call(GetState, f"{NODE}/get_state", GetState.Request())
    assert state.current_state.label == "active"
    node.send(signal.SIGINT)
    assert node.wait() == 0
    wrong = start_node("traffic", "-p", "lines:=/nowhere.yaml")
    assert wrong.wait() == 1
    (sentence,) = [line for line in wrong.output.splitlines() if not line.startswith("[")]
    assert sentence.startswith("traffic_tracker: ")
    assert "/nowhere.yaml" in sentence
