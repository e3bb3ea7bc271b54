# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node's kept target: taken up again, or left out with a warning, whatever the file holds."""

from __future__ import annotations

import json
import os
import time

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from hypothesis import given
from hypothesis import strategies as st
from tracker_rig import TARGET, Rig, on_target, overrides, road
from traffic_rig import TrafficRig, lanes

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.node.kept_target import KeptTarget
from vehicle_pf_tracker.ros.own_files import own_file

GOOD = json.dumps(list(TARGET))


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    folder = tmp_path / "vehicle_pf_tracker"
    folder.mkdir()
    return folder / "apf_tracker.target.json"


def write(file, text, age=1.0):
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    os.utime(file, (time.time() - age,) * 2)


def test_a_saved_target_is_loaded(file):
    KeptTarget("/apf_tracker").save(Box(1.5, 2.0, 30.0, 20.0))
    assert KeptTarget("/apf_tracker").load() == Box(1.5, 2.0, 30.0, 20.0)
    assert file.stat().st_mode & 0o777 == 0o600
    assert [path.name for path in file.parent.iterdir()] == [file.name]


def test_without_a_file_there_is_none(file):
    assert KeptTarget("/apf_tracker").load() is None


UNUSABLE = {
    "centre outside": "[-30, 120, 40, 24]",
    "beyond every image": "[1e9, 120, 40, 24]",
    "NaN": "[NaN, 1, 2, 3]",
    "infinite": "[1, 1, Infinity, 3]",
    "too large for a float": f"[1{'0' * 400}, 1, 2, 3]",
    "no area": "[10, 10, 0, 5]",
    "negative": "[10, 10, -8, 5]",
    "three numbers": "[1, 2, 3]",
    "words": '["a", "b", "c", "d"]',
    "null": "null",
    "an object": '{"x": 1}',
    "no JSON": "[1, 2",
    "nothing": "",
    "no text": b"\xff\xfe\x00",
    "nested": "[" * 3000,
    "nested deeper": "[" * 100_000,
    "long": "[" + "1, " * 100_000 + "1]",
}


@pytest.mark.parametrize("text", UNUSABLE.values(), ids=UNUSABLE)
def test_a_target_that_cannot_be_is_left_out(file, text):
    write(file, text)
    with pytest.raises(InputError, match="target"):
        KeptTarget("/apf_tracker").load()


@pytest.mark.parametrize("age", [31.0, 86400.0 * 30, -60.0, -86400.0 * 30])
def test_a_target_of_another_time_is_left_out(file, age):
    write(file, GOOD, age)
    with pytest.raises(InputError, match=r"s old|s of the future"):
        KeptTarget("/apf_tracker").load()


@pytest.mark.parametrize("age", [29.0, 0.0, -0.5])
def test_a_target_of_a_moment_ago_is_taken_up(file, age):
    write(file, GOOD, age)
    assert KeptTarget("/apf_tracker").load() == Box(*map(float, TARGET))


@pytest.mark.parametrize("kind", ["pipe", "folder", "device"])
def test_what_is_no_file_is_left_out_at_once(file, kind):
    if kind == "pipe":
        os.mkfifo(file)
    elif kind == "folder":
        file.mkdir()
    else:
        file.symlink_to("/dev/zero")
    with pytest.raises(InputError):
        KeptTarget("/apf_tracker").load()


def test_a_pipe_where_the_target_is_written_is_replaced(file):
    os.mkfifo(file)
    os.mkfifo(file.with_name(f"{file.name}.partial"))
    KeptTarget("/apf_tracker").save(Box(1, 2, 30, 20))
    assert KeptTarget("/apf_tracker").load() == Box(1, 2, 30, 20)


@given(st.binary(max_size=200))
def test_no_content_ends_the_node(content):
    file = own_file("/apf_tracker", "target.json")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(content)
    try:
        box = KeptTarget("/apf_tracker").load()
    except InputError:
        return
    assert box is not None and min(box.width, box.height) >= 1


@pytest.fixture(autouse=True)
def _home(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_HOME", str(tmp_path))


@pytest.mark.ros
@pytest.mark.parametrize("name", ["centre outside", "NaN", "nested deeper"])
def test_a_node_waits_for_a_target_instead(bench, file, name, capfd):
    write(file, UNUSABLE[name])
    assert Rig(bench, overrides(keep_target=True)).play(road(2)) == ["WAITING"] * 2
    assert "the kept target is left out" in capfd.readouterr().err


@pytest.mark.ros
def test_a_node_keeps_the_target_of_its_parameters(bench, file):
    write(file, GOOD, age=3600)
    assert Rig(bench, on_target(keep_target=True)).play(road(2)) == ["TRACKING"] * 2


@pytest.mark.ros
def test_a_target_outside_the_images_is_not_followed(bench, file):
    write(file, "[3000, 2000, 40, 24]")
    modes = Rig(bench, overrides(keep_target=True)).play(road(3))
    assert modes[1:] == ["WAITING"] * 2


@pytest.mark.ros
def test_a_vehicle_outside_the_images_costs_the_others_nothing(bench, file):
    write(file.with_name("traffic_tracker.target.json"), "[3000, 2000, 40, 24]")
    rig = TrafficRig(bench, overrides(keep_target=True))
    answers = rig.play(lanes(3))
    assert [one.status[0].message for one in answers[1:]] == ["WAITING"] * 2
