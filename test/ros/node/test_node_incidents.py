# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What a node keeps of its last seconds, and what it says of a step that takes too long."""

from __future__ import annotations

import signal
import threading
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from failing import failing
from sensor_msgs.msg import Image
from std_srvs.srv import Trigger
from tracker_rig import (
    HEIGHT,
    QUEUE,
    TARGET,
    WIDTH,
    Rig,
    diagnostics_of,
    header,
    on_target,
    overrides,
    road,
    values_of,
)
from traffic_rig import WARM_UP, TrafficRig, boxes, lanes

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.results.estimates import read_estimates
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.node import incidents
from vehicle_pf_tracker.ros.node.incidents import IncidentRecorder
from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode
from vehicle_pf_tracker.trackers.base import BaseTracker
from vehicle_pf_tracker.trackers.registry import find_variant

pytestmark = pytest.mark.ros


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    return tmp_path / "vehicle_pf_tracker"


def test_a_snapshot_can_be_run_again_bit_for_bit(bench, tmp_path):
    rig = Rig(bench, on_target(incident_memory=100, seed=3))
    answers = [values_of(rig.show_frame(frame, i)) for i, frame in enumerate(road(12))]
    told = bench.call(Trigger, f"{rig.name}/snapshot", Trigger.Request())
    assert told.success
    found = told.message.removeprefix("writing to ")
    bench.wait_for(Path(found, "parameters.yaml").is_file)
    assert Recording(found).frame_count == 12
    words = ["run", found, "--variant", "apf", "--params", f"{found}/parameters.yaml"]
    assert main([*words, "-o", str(tmp_path / "out")]) == 0
    rows = read_estimates(tmp_path / "out" / "estimates.csv")
    assert [(repr(row.x), repr(row.y)) for row in rows] == [(a["x"], a["y"]) for a in answers]


def test_a_session_that_starts_anew_writes_what_led_to_it(bench, folder, monkeypatch):
    rig = Rig(bench, on_target(incident_memory=100))
    rig.play(road(4))
    monkeypatch.setattr(BaseTracker, "step", failing(BaseTracker.step, {0, 1}))
    rig.play(road(4), 4)
    (written,) = bench.wait_for(lambda: list(folder.glob("apf_tracker_*/parameters.yaml")))
    assert Recording(written.parent).frame_count == 6


def test_images_are_answered_while_a_snapshot_is_written(bench, tmp_path, monkeypatch, capfd):
    may_end = threading.Event()
    write = RecordingWriter.write_serialized

    def slow(*given):
        may_end.wait(60.0)
        write(*given)

    monkeypatch.setattr(RecordingWriter, "write_serialized", slow)
    rig = Rig(bench, on_target(incident_memory=100))
    frames = road(8)
    rig.play(frames[:4])
    calls = [bench.call(Trigger, f"{rig.name}/snapshot", Trigger.Request()) for _ in range(2)]
    assert [call.success for call in calls] == [True, False]
    assert "still being written" in calls[1].message
    assert rig.play(frames[4:], 4) == ["TRACKING"] * 4
    may_end.set()
    found = Path(calls[0].message.removeprefix("writing to "))
    bench.wait_for((found / "parameters.yaml").is_file)
    assert Recording(found).frame_count == 4


def test_a_snapshot_that_cannot_be_written_says_why(bench, tmp_path, monkeypatch):
    rig = Rig(bench, on_target(incident_memory=100))
    rig.play(road(2))
    (tmp_path / "file").touch()
    monkeypatch.setenv("ROS_HOME", str(tmp_path / "file"))
    answer = bench.call(Trigger, f"{rig.name}/snapshot", Trigger.Request())
    assert not answer.success
    assert "Not a directory" in answer.message


def test_two_cameras_have_snapshots_and_reports_of_their_own(bench, monkeypatch):
    monkeypatch.setattr(incidents.time, "strftime", lambda _: "now")  # in the same second
    image = image_message(header(0), road(1)[0])
    written = []
    for side in ("front", "rear"):
        options = {"namespace": side, "parameter_overrides": on_target(incident_memory=10)}
        bench.add(TrackerNode(find_variant("apf"), context=bench.context, **options))
        modes = bench.collect(DiagnosticArray, f"/{side}/apf_tracker/mode", QUEUE)
        camera = bench.publisher(Image, f"/{side}/image", QUEUE)
        bench.publish_until(lambda: modes, camera, image)  # noqa: B023 - called at once
        answer = bench.call(Trigger, f"/{side}/apf_tracker/snapshot", Trigger.Request())
        written.append(Path(answer.message.removeprefix("writing to ")))
    assert [path.name for path in written] == ["front.apf_tracker_now", "rear.apf_tracker_now"]
    for path in written:
        bench.wait_for((path / "parameters.yaml").is_file)
        assert Recording(path).frame_count >= 1
    for side in ("front", "rear"):
        told = diagnostics_of(bench, f"{side}/apf_tracker", lambda table: True)
        assert int(told["images"]) >= 1


def test_without_memory_there_is_no_such_service(bench):
    rig = Rig(bench)
    assert not [name for name, _ in rig.node.get_service_names_and_types() if "snapshot" in name]


def test_what_is_kept_is_bounded_by_memory_and_by_time():
    now, size = [0.0], 3 * WIDTH * HEIGHT
    frame = road(1)[0]
    kept = IncidentRecorder("node", 3 * size, lambda: now[0])
    for index in range(10):
        kept.keep(image_message(header(index), frame))
    assert kept.count == 2  # a header is some bytes more
    now[0] = 20.0
    kept.keep(image_message(header(10), frame))
    assert kept.count == 1


def test_a_killed_node_goes_on_with_its_target(bench, start_node, folder):
    camera = bench.publisher(Image, "image", QUEUE, count=0)
    frame = road(1)[0]
    names = ("x", "y", "width", "height")
    target = [w for n, v in zip(names, TARGET, strict=True) for w in ("-p", f"target.{n}:={v}.0")]
    keep = ["-p", "keep_target:=true"]
    first = start_node("pf", *keep, *target)
    first.wait_for_output("ready")
    index = iter(range(10_000))

    def shown():
        camera.publish(image_message(header(next(index)), frame))
        return list(folder.glob("*.json"))

    bench.publish_until(shown, camera, image_message(header(0), frame))
    first.send(signal.SIGKILL)
    first.wait()
    second = start_node("pf", *keep)
    second.wait_for_output("going on with the target")
    second.wait_for_output(", following ")  # in its last words before it waits for images
    modes = bench.collect(DiagnosticArray, "/pf_tracker/mode")
    bench.publish_until(
        lambda: modes and modes[-1].status[0].message == "TRACKING", camera,
        image_message(header(0), frame),
    )  # fmt: skip
    x = TARGET[0] + TARGET[2] / 2
    assert float(values_of(modes[-1])["x"]) == pytest.approx(x, abs=4)


def test_the_selection_of_a_killed_node_comes_back(bench, folder):
    parameters = overrides(keep_target=True, detector__kind="none")
    frames = lanes(WARM_UP + 14)[WARM_UP + 10 :]
    for turn in ("first", "second"):
        rig = TrafficRig(bench, parameters)
        if turn == "first":
            x, y, width, height = boxes(WARM_UP + 10)[0]
            rig.node.feed.start_on(Box(*map(float, (x, y, width, height))))
        rig.play(frames)
        assert rig.vehicles.selected is not None, turn
        bench.remove(rig.node)


def test_a_target_that_cannot_be_saved_costs_no_answer(bench, tmp_path, monkeypatch, capfd):
    (tmp_path / "file").touch()
    monkeypatch.setenv("ROS_HOME", str(tmp_path / "file"))
    rig = Rig(bench, on_target(keep_target=True))
    assert rig.play(road(3)) == ["TRACKING"] * 3
    assert "the target cannot be saved: Not a directory" in capfd.readouterr().err
