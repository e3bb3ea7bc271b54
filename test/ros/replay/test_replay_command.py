# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The command itself, in a process of its own, to real nodes in processes of theirs."""

import signal

import pytest

pytest.importorskip("rclpy")

import cv2
from replay_rig import COMMAND, IMAGE_TOPIC, StubTracker, record, spinning
from tracker_rig import FIRST_NS, PERIOD_NS, SPEED, TARGET, road

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.results.estimates import read_estimates
from vehicle_pf_tracker.trackers.registry import find_variant

pytestmark = pytest.mark.ros

FRAMES = 40


def drive(folder, compressed=False):
    """Record a vehicle on a road; the truth begins at the third frame."""
    x, y, width, height = TARGET
    with RecordingWriter(folder) as writer:
        for index, frame in enumerate(road(FRAMES)):
            stamp = FIRST_NS + index * PERIOD_NS
            if compressed:
                writer.write_compressed(stamp, "jpeg", cv2.imencode(".jpg", frame)[1].tobytes())
            else:
                writer.write_image(stamp, frame)
            if index >= 2:
                box = Box(x + SPEED * index, y, width, height)
                writer.write_truth(Truth(stamp, box, Occlusion.NONE))
    return Recording(folder)


def numbers(rows):
    """All that must repeat: every column but the time that a step took."""
    return [
        (row.frame, row.stamp_ns, row.x, row.y, row.width, row.height, row.mode,
         row.confidence, row.n_eff)
        for row in rows
    ]  # fmt: skip


def track_offline(variant, recording):
    kind = find_variant(variant)
    parameters = from_mapping(kind.parameters, {"seed": 5})
    tracker = OfflineTracker(kind, parameters, first_truth=recording.first_truth())
    return list(tracker.rows((item.stamp_ns, item.frame) for item in recording.frames()))


@pytest.mark.parametrize(
    ("variant", "compressed", "transport", "words"),
    [
        ("apf", False, "raw", []),
        pytest.param("apf", True, "raw", ["--decompress"], marks=pytest.mark.slow),
        pytest.param("apf", True, "compressed", [], marks=pytest.mark.slow),
    ],
)
def test_lockstep_and_offline_runs_give_identical_numbers(
    start_node, start_process, tmp_path, variant, compressed, transport, words
):
    recording = drive(tmp_path / "bag", compressed)
    offline = track_offline(variant, recording)
    assert [row.mode for row in offline[:3]] == ["WAITING", "WAITING", "TRACKING"]
    settings = [f"image_transport:={transport}", "seed:=5"]
    options = [word for setting in settings for word in ("-p", setting)]
    start_node(variant, *options, "-r", f"image:={IMAGE_TOPIC}")
    words = [*words, "--lockstep", "--node", f"{variant}_tracker", "--timeout", "20"]
    for turn in ("first", "second"):
        out = tmp_path / turn
        replay = start_process(*COMMAND, str(recording.path), *words, "-o", str(out))
        assert replay.wait() == 0, replay.output
        assert f"/{variant}_tracker: {FRAMES} answered, 0 not" in replay.output
        assert numbers(read_estimates(out / "estimates.csv")) == numbers(offline)


def test_ctrl_c_twice_ends_well(start_process, tmp_path, bench):
    seen = []
    StubTracker(bench, on_image=seen.append)
    record(tmp_path / "bag")
    words = ["--loop", "--lockstep", "--node", "stub_tracker", "--timeout", "20"]
    replay = start_process(*COMMAND, str(tmp_path / "bag"), *words, TMPDIR=str(tmp_path))
    bench.wait_for(lambda: len(seen) > 20)
    replay.send(signal.SIGINT)
    replay.send(signal.SIGINT)
    with spinning(bench):
        assert replay.wait() == 0, replay.output
    assert "interrupted after" in replay.output
    assert "Traceback" not in replay.output
    assert list(tmp_path.glob("vehicle_pf_tracker_*")) == []  # the transport profile is gone


def test_a_mute_node_ends_with_status_1_and_one_line(start_process, tmp_path, bench):
    StubTracker(bench, mute_at=2)
    record(tmp_path / "bag")
    words = ["--lockstep", "--node", "stub_tracker", "--timeout", "0.5"]
    replay = start_process(*COMMAND, str(tmp_path / "bag"), *words)
    with spinning(bench):
        assert replay.wait() == 1
    *_, line = replay.output.splitlines()  # a slow replay also tells its progress
    assert "/stub_tracker did not answer frame 2" in line
    assert "Traceback" not in replay.output


def test_no_target_is_a_usage_error(start_process, tmp_path, bench):
    StubTracker(bench)
    record(tmp_path / "bag", truth_from=None)
    words = ["--lockstep", "--node", "stub_tracker", "--timeout", "20"]
    replay = start_process(*COMMAND, str(tmp_path / "bag"), *words)
    with spinning(bench):
        assert replay.wait() == 2
    assert "--target x,y,w,h" in replay.output


def test_a_truncated_recording_is_played_as_far_as_it_goes(start_process, tmp_path, bench):
    stub = StubTracker(bench)
    (file,) = drive(tmp_path / "bag").path.glob("*.mcap")
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(file.read_bytes()[: file.stat().st_size * 2 // 3])
    left = Recording(cut).frame_count
    assert 0 < left < FRAMES
    words = ["--lockstep", "--node", "stub_tracker", "--timeout", "20"]
    replay = start_process(*COMMAND, str(cut), *words)
    with spinning(bench):
        assert replay.wait() == 0, replay.output
    assert stub.stamps == [FIRST_NS + index * PERIOD_NS for index in range(left)]
    assert f"truncated after frame {left}" in replay.output
    assert f"played {left} frames" in replay.output
