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

"""The demo where ROS is not installed: everything offline, and a sentence about what is missing."""

import json
import sys

import cv2
import pytest

from vehicle_pf_tracker.cli import demo
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.reader import Recording


@pytest.fixture
def without_ros(monkeypatch):
    """Hide rclpy, and the modules that have imported it."""
    for name in list(sys.modules):
        if name.startswith("vehicle_pf_tracker.ros."):
            monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "rclpy", None)
    monkeypatch.setenv("ROS_DOMAIN_ID", "17")


@pytest.fixture
def short(monkeypatch):
    """Take a small scene, and contestants that start at once."""
    monkeypatch.setattr(demo, "SCENE", "bar")
    monkeypatch.setattr(demo, "CONTESTANTS", {"apf": {}, "pf": demo.CONTESTANTS["pf"]})


@pytest.mark.slow
def test_everything_else_is_done_and_said(tmp_path, without_ros, short, capsys):
    assert main(["demo", "-o", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    note = err.splitlines()[0]
    assert "no Python module rclpy" in note
    assert "the nodes are left out and everything is tracked offline" in note
    assert ". apf, pf offline, and the video" in out
    assert "lock-step" not in out
    assert "same numbers offline" not in out
    assert f"the picture is {tmp_path / 'demo.png'}" in out
    assert f"the video is {tmp_path / 'demo.mp4'}" in out
    frames = Recording(tmp_path / "recording").frame_count
    video = cv2.VideoCapture(str(tmp_path / "demo.mp4"))
    assert video.get(cv2.CAP_PROP_FRAME_COUNT) == frames
    run = json.loads((tmp_path / "pf" / "run.json").read_text())
    assert run["notices"] == []
    assert json.loads((tmp_path / "apf" / "metrics.json").read_text())["frames_scored"] == frames
    assert (tmp_path / "demo.png").is_file()
    assert (tmp_path / "summary.md").is_file()


def test_ros_is_looked_for_before_anything_is_rendered(tmp_path, without_ros, monkeypatch, capsys):
    (tmp_path / "file").touch()
    monkeypatch.setattr(demo, "record_scene", None)
    assert main(["demo", "-o", str(tmp_path / "file")]) == 1
    note, error = capsys.readouterr().err.splitlines()
    assert "no Python module rclpy" in note
    assert "is a file" in error


@pytest.mark.parametrize("long", [True, False])
def test_kernels_are_ready_before_nodes_start(tmp_path, monkeypatch, capsys, long):
    order = []
    monkeypatch.setattr(demo, "takes_long", lambda _choice: long)
    monkeypatch.setattr(demo, "load_kernels", order.append)
    monkeypatch.setattr(demo, "absence_of_ros", lambda: "")
    monkeypatch.setattr(demo, "record", lambda _path: None)

    def through_ros(_recording):
        order.append("nodes")
        raise InputError("enough")

    monkeypatch.setattr(demo, "track_through_ros", through_ros)
    assert main(["demo", "-o", str(tmp_path)]) == 1
    assert order == (["auto", "nodes"] if long else ["nodes"])
    assert ("1. kernels" in capsys.readouterr().out) == long


def test_a_ros_that_cannot_be_loaded_is_named(monkeypatch):
    def broken(_name):
        raise ImportError("librcl.so: cannot open shared object file")

    monkeypatch.setattr(demo, "import_module", broken)
    assert demo.absence_of_ros() == (
        "ROS cannot be loaded (librcl.so: cannot open shared object file)"
    )


def test_a_missing_module_of_our_own_is_not_taken_for_missing_ros(monkeypatch):
    def broken(_name):
        raise ModuleNotFoundError("no", name="vehicle_pf_tracker.ros.gone")

    monkeypatch.setattr(demo, "import_module", broken)
    with pytest.raises(ModuleNotFoundError):
        demo.absence_of_ros()
