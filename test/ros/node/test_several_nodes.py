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

"""`vehicle_tracker`: any variant as a node, a plug-in's too, and several in one process."""

import os
import signal
import sys

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from plug_in_sample import install
from sensor_msgs.msg import Image
from tracker_rig import FIRST_NS, PERIOD_NS, QUEUE, TARGET, header, road, values_of

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.trackers.registry import find_variant, plug_ins
from vehicle_pf_tracker.trackers.session import Session

pytestmark = pytest.mark.ros

CODE = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main('vehicle'))"
X, Y, WIDTH, HEIGHT = TARGET
CAMERAS = f"""
cameras:
  front: {{topic: /front/image, variant: pf, target: [{X}, {Y}, {WIDTH}, {HEIGHT}]}}
  rear:
    topic: /rear/image
    variant: steady
    target: [{X}, {Y}, {WIDTH}, {HEIGHT}]
    parameters: {{trust: 0.5}}
"""
COUNT = 5


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
    bench, start_any, site, tmp_path, monkeypatch
):
    (tmp_path / "cameras.yaml").write_text(CAMERAS)
    process = start_any("--cameras", str(tmp_path / "cameras.yaml"))
    monkeypatch.syspath_prepend(site)
    plug_ins.cache_clear()
    for camera, variant, own in (("front", "pf", {}), ("rear", "steady", {"trust": 0.5})):
        answers = bench.collect(DiagnosticArray, f"/{camera}/{variant}_tracker/mode", QUEUE)
        publisher = bench.publisher(Image, f"/{camera}/image", QUEUE)
        found = find_variant(variant)
        session = Session(found, found.parameters(**own))
        session.set_target(Box(*map(float, TARGET)))
        for index, frame in enumerate(road(COUNT)):
            publisher.publish(image_message(header(index), frame))
            bench.wait_for(lambda wanted=index + 1, got=answers: len(got) == wanted)
            expected = session.feed(frame, FIRST_NS + index * PERIOD_NS)
            values = values_of(answers[-1])
            assert (float(values["x"]), float(values["y"])) == expected.position
    plug_ins.cache_clear()
    process.send(signal.SIGINT)
    assert process.wait() == 0
    assert "Traceback" not in process.output


def test_a_plug_in_is_a_node_of_its_own_name(bench, start_any):
    node = start_any("--variant", "steady", "--ros-args", "-r", "image:=/camera/image")
    node.wait_for_output("ready: images on /camera/image")
    assert ("steady_tracker", "/") in bench.node.get_node_names_and_namespaces()


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        (["--help"], 0, "usage: vehicle_tracker (--variant NAME | --cameras FILE)"),
        ([], 2, "usage: vehicle_tracker"),
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
