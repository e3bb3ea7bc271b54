# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Decisions of the launch files: which images, which parameters, which cameras."""

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

pytest.importorskip("rclpy")

from replay_rig import record

from vehicle_pf_tracker.cli.main import make_parser
from vehicle_pf_tracker.cli.replay import Request
from vehicle_pf_tracker.cli.requests import request_of
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.ros.camera_file import read_cameras
from vehicle_pf_tracker.ros.launching import TRACKER_ARGUMENTS as NODE
from vehicle_pf_tracker.ros.launching import parameter_file
from vehicle_pf_tracker.ros.replay.launched_replay import REPLAY_ARGUMENTS as REPLAY
from vehicle_pf_tracker.ros.replay.launched_replay import queue_depth, replay_words
from vehicle_pf_tracker.ros.replay.publishing import recorded_images

FILE = """
cameras:
  front:
    topic: /front/image_raw
    target: [310, 202, 40, 30]
    parameters: {num_particles: 300, motion: {sigma_w: 5}}
    variant: apf
  rear_2:
    topic: /rear/camera
    transport: compressed
    params_file: tuned.yaml
"""


def test_images_are_where_the_recording_has_them(tmp_path):
    raw = recorded_images(record(tmp_path / "raw"))
    assert raw == ("/camera/image_raw", "/camera/image_raw", "raw", "/camera/image_raw")
    name = "/camera/image_raw/compressed"
    small = recorded_images(record(tmp_path / "small", compressed=True))
    assert small == (name, name[:-11], "compressed", name)


def test_compressed_images_of_any_name_are_published_where_a_node_listens():
    found = SimpleNamespace(image_topic="/front/jpeg", image_type="sensor_msgs/msg/CompressedImage")
    assert recorded_images(found) == (
        "/front/jpeg", "/front/jpeg", "compressed", "/front/jpeg/compressed",
    )  # fmt: skip


DEFAULTS = {name: default for name, (default, _) in {**NODE, **REPLAY}.items()}


def words_of(folder, **given):
    given = {**DEFAULTS, "recording": str(folder), **given}
    return replay_words(given, recorded_images(record(folder))), queue_depth(given)


def test_a_launched_replay_is_in_lockstep_at_the_pace_of_the_recording(tmp_path):
    words, depth = words_of(tmp_path)
    assert words == [
        str(tmp_path), "--topic", "/camera/image_raw", "--rate", "1.0", "--node", "/apf_tracker",
        "--timeout", "60", "--lockstep",
    ]  # fmt: skip
    assert depth == ""


def test_a_launched_replay_in_real_time_has_a_queue(tmp_path):
    words, depth = words_of(tmp_path, lockstep="False", loop="true")
    assert "--lockstep" not in words
    assert words[-1] == "--loop"
    assert int(depth) >= 10


def test_the_words_of_a_launched_replay_are_options_of_the_replay(tmp_path):
    words, _ = words_of(
        tmp_path, loop="true", use_sim_time="true", target="1,2,3,4", namespace="/front", name="a"
    )
    request = request_of(Request, make_parser(["replay"]).parse_args(["replay", *words]))
    assert (request.loop, request.lockstep, request.clock) == (True, True, 100.0)
    assert list(request.nodes) == ["front/a"]


def test_a_camera_may_have_the_node_of_many_vehicles(tmp_path):
    path = tmp_path / "cameras.yaml"
    path.write_text(
        "cameras:\n  gate:\n    topic: /gate/image_raw\n    variant: traffic\n"
        "    parameters: {detector: {kind: topic, max_wait: 1}, lines: gate.yaml}\n"
    )
    (camera,) = read_cameras(str(path))
    assert camera.variant == "traffic"
    assert dict(camera.values) == {
        "detector.kind": "topic", "detector.max_wait": 1.0, "lines": "gate.yaml",
    }  # fmt: skip


def test_the_parameter_file_of_the_variant_is_the_default(tmp_path):
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "pf.yaml").write_text("a: 1")
    assert parameter_file("", "pf", str(tmp_path)) == str(tmp_path / "config" / "pf.yaml")
    with pytest.raises(InputError, match=r"cannot read the parameter file /nowhere\.yaml"):
        parameter_file("/nowhere.yaml", "pf", str(tmp_path))
    with pytest.raises(InputError, match="there is no variant 'pff'"):
        parameter_file("", "pff", str(tmp_path))


def test_cameras_have_parameters_as_they_are_declared(tmp_path):
    (tmp_path / "cameras.yaml").write_text(FILE)
    (tmp_path / "tuned.yaml").write_text("/**:\n  ros__parameters:\n    seed: 7\n")
    front, rear = read_cameras(str(tmp_path / "cameras.yaml"))
    assert (front.name, front.topic, front.variant) == ("front", "/front/image_raw", "apf")
    written = read_yaml(Path(front.write_parameters()), "apf_tracker")
    assert written == {
        "num_particles": 300, "motion.sigma_w": 5.0,
        "target.x": 310.0, "target.y": 202.0, "target.width": 40.0, "target.height": 30.0,
    }  # fmt: skip
    assert all(type(value) is float for key, value in written.items() if key != "num_particles")
    assert (rear.variant, dict(rear.values)) == (
        "fusion", {"seed": 7, "image_transport": "compressed"},
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a: 1", "has no section `cameras`"),
        ("cameras: []", "has no section `cameras`"),
        ("cameras: {a: 5}", "the camera a in .*: it needs a topic"),
        ("cameras: {a: {variant: apf}}", "it needs a topic"),
        ("cameras: {a: {topic: /i, varriant: apf}}", "there is no parameter 'varriant'"),
        ("cameras: {a: {topic: /i, variant: best}}", "there is no variant 'best'"),
        ("cameras: {a: {topic: /i//j}}", "its topic '/i//j' is not a topic name"),
        ("cameras: {a-b: {topic: /i}}", "cannot name a namespace"),
        # A remap rule that cannot be parsed ended each node, and its respawn, for ever.
        ("cameras: {a: {topic: ///}}", "the camera a in .*: its topic '///' is not a topic name"),
        ("cameras: {a: {topic: 5}}", "its topic 5 is not a topic name"),
        ("cameras: {a: {topic: /i, target: [1, 2]}}", r"not \[x, y, width, height\]"),
        ("cameras: {a: {topic: /i, target: [-90, 2, 30, 30]}}", "outside every image"),
        ("cameras: {a: {topic: /i, parameters: {lost_aftr: 2}}}", "lost_after"),
        ("cameras: {a: {topic: /i, parameters: {lost_after: -2}}}", "lost_after must be"),
        ("cameras: {a: {topic: /i, params_file: no.yaml}}", "cannot read the parameter file"),
        ("cameras: {a: {topic: /i}, a: {topic: /j}}", "the key 'a' is there twice"),
    ],
)
def test_a_file_of_cameras_that_does_not_fit_is_refused(tmp_path, text, said):
    (tmp_path / "cameras.yaml").write_text(text)
    with pytest.raises(InputError, match=said):
        read_cameras(str(tmp_path / "cameras.yaml"))


def test_the_written_files_are_those_that_nodes_read(tmp_path):
    (tmp_path / "cameras.yaml").write_text("cameras: {a: {topic: /i, parameters: {lost_after: 2}}}")
    (camera,) = read_cameras(str(tmp_path / "cameras.yaml"))
    path = camera.write_parameters()
    assert parameter_file(path, "fusion", "") == path
    assert read_yaml(Path(path), "fusion_tracker") == {"lost_after": 2.0}


LAUNCH = """
import sys, tempfile
from vehicle_pf_tracker.ros.camera_file import read_cameras
written = [c.write_parameters() for c in read_cameras(sys.argv[1]) * 2]
assert len(set(written)) == 2
print(*written, sep="\\n", flush=True)
input()
"""


@pytest.mark.parametrize("ending", ["\n", ""])
def test_nothing_is_left_when_a_launch_ends(tmp_path, ending):
    (tmp_path / "cameras.yaml").write_text("cameras: {a: {topic: /i, parameters: {lost_after: 2}}}")
    with subprocess.Popen(
        [sys.executable, "-c", LAUNCH, str(tmp_path / "cameras.yaml")],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    ) as launch:  # fmt: skip
        written = [Path(launch.stdout.readline().strip()) for _ in range(2)]
        assert all(path.is_file() for path in written)
        folder = written[0].parent.parent
        launch.communicate(ending)
    assert launch.returncode == (not ending)  # without a line it ends with an exception
    assert folder.name.startswith("vehicle_pf_tracker_")
    assert not folder.exists()
