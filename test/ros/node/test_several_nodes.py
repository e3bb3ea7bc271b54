# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`vehicle_tracker`: any variant as a node, a plug-in's too, and several in one process."""

import os
import signal
import sys

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from plug_in_sample import install
from small_recordings import record

from vehicle_pf_tracker import track
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.replaying import replay
from vehicle_pf_tracker.trackers.registry import plug_ins

pytestmark = pytest.mark.ros

CODE = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main('vehicle'))"
CAMERAS = """
cameras:
  front: {topic: /camera/image_raw, variant: pf}
  rear: {topic: /camera/image_raw, variant: steady, parameters: {trust: 0.5}}
"""
NODES = {"front/pf_tracker": ("pf", {}), "rear/steady_tracker": ("steady", {"trust": 0.5})}


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Folder that the plug-in of docs/library.md is installed in."""
    return install(tmp_path_factory.mktemp("plug_in"))


@pytest.fixture
def start_any(start_process, site):
    """Return a function that runs `vehicle_tracker` where the plug-in is installed."""
    path = os.pathsep.join([str(site), *sys.path])
    return lambda *words: start_process("-c", CODE, *words, PYTHONPATH=path)


def test_several_nodes_share_a_process_and_answer_as_offline(
    start_any, site, tmp_path, monkeypatch
):
    (tmp_path / "cameras.yaml").write_text(CAMERAS)
    process = start_any("--cameras", str(tmp_path / "cameras.yaml"))
    rec = record(tmp_path / "rec")
    report = replay(Recording(rec), ReplayOptions(lockstep=True, nodes=tuple(NODES)))
    monkeypatch.syspath_prepend(site)
    plug_ins.cache_clear()
    for node in report.nodes:
        variant, own = NODES[node.name.lstrip("/")]
        expected = track(rec, None, variant, **own)
        assert [row.position for row in node.rows] == [row.position for row in expected]
    plug_ins.cache_clear()
    process.send(signal.SIGINT)
    assert process.wait() == 0
    assert "Traceback" not in process.output


def test_a_plug_in_is_a_node_of_its_own_name(bench, start_any):
    node = start_any("--variant", "steady", "--ros-args", "-r", "image:=/camera/image")
    node.wait_for_output("ready: images on /camera/image")
    own = ("steady_tracker", "/")
    bench.wait_for(lambda: own in bench.node.get_node_names_and_namespaces())


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        (["--help"], 0, "usage: vehicle_tracker (--variant NAME | --cameras FILE)"),
        (["apf"], 2, "unknown arguments: apf"),
        (["--variant"], 1, "there is no variant ''"),
        (["--variant", "stedy"], 1, "(did you mean 'steady'?)"),
        (["--cameras", "/nowhere.yaml"], 1, "cannot read the file of cameras /nowhere.yaml"),
    ],
)
def test_other_words_are_answered_in_a_sentence(start_any, words, status, sentence):
    process = start_any(*words)
    assert process.wait() == status
    assert sentence in process.output
    assert "Traceback" not in process.output
