# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every `ros2` command on a page is given to running nodes, as `ros2` itself is no wheel.

Launch files are judged in test/cli/test_documented_commands.py and run in test/packaging/.
"""

from __future__ import annotations

import re
import shlex
from importlib import import_module
from pathlib import Path

import pytest
import yaml

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from rcl_interfaces.msg import Parameter
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import get_parameter_value
from sensor_msgs.msg import Image
from tracker_rig import Rig, header, road
from traffic_rig import TrafficRig, lanes

from vehicle_pf_tracker.ros.messages import image_message

pytestmark = pytest.mark.ros

ROOT = Path(__file__).resolve().parents[2]
JUDGED_ELSEWHERE = {"launch", "security"}
"""Verbs of `ros2`: `security` needs a key store, its policy is that of test_node_security.py."""
SIZE = 640, 480


def documented():
    """Yield the words after `ros2` of each line of shell code that is no launch."""
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        for block in re.findall(r"^```sh\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE):
            for line in block.replace("\\\n", " ").splitlines():
                words = shlex.split(re.sub(r" > .*", "", line), comments=True)
                if words[:1] == ["ros2"] and "…" not in words and words[1] not in JUDGED_ELSEWHERE:
                    yield pytest.param(words[1:], id=f"{page.name}: {' '.join(words[1:])}")


COMMANDS = list({one.id: one for one in documented()}.values())


@pytest.fixture
def rig(bench):
    """The nodes that the pages speak of, which have seen an image or more."""
    tracker = Rig(bench, variant="fusion")
    tracker.show_frame(road(1, *SIZE)[0], 0)

    def traffic():
        made = TrafficRig(bench)
        made.play(lanes(48), 1)
        return made

    tracker.traffic = traffic
    return tracker


def filled(message, values):
    """Set a message's fields as `ros2 topic pub` does."""
    for name, value in values.items():
        known = message.get_fields_and_field_types()
        assert name in known
        if isinstance(value, dict):
            filled(getattr(message, name), value)
        else:
            setattr(message, name, value)
    return message


def give(rig, topic, kind, text):
    if topic.startswith("/traffic_tracker"):
        rig = rig.traffic()
        text = re.sub(r"data: \d+", f"data: {rig.vehicles.estimates[0].identity}", text)
    package, _, name = kind.partition("/msg/")
    message = getattr(import_module(f"{package}.msg"), name)()
    publisher = rig.bench.publisher(type(message), topic)
    publisher.publish(filled(message, yaml.safe_load(text)))
    if topic.endswith("/select"):
        rig.bench.wait_for(lambda: rig.vehicles.selection.identity == message.data)
    else:
        rig.bench.wait_for(lambda: rig.node.feed.asked is not None)
        answer = rig.show_frame(road(1, *SIZE)[0], 1)
        assert answer.status[0].message == "TRACKING"
    assert rig.node.diagnostics.health.refusals.count == 0


def change(rig, node, name, text):
    request = SetParameters.Request(
        parameters=[Parameter(name=name, value=get_parameter_value(text))]
    )
    (result,) = rig.bench.call(SetParameters, f"{node}/set_parameters", request).results
    assert result.successful, result.reason


@pytest.mark.parametrize("words", COMMANDS)
def test_the_command_does_what_its_page_says(rig, start_process, words):
    match words:
        case ["topic", "pub", "--once", topic, kind, text]:
            give(rig, topic, kind, text)
        case ["topic", "echo", topic]:
            assert topic in dict(rig.node.get_topic_names_and_types())
        case ["param", "set", node, name, value]:
            change(rig, node, name, value)
        case ["param", "dump", node]:
            assert f"/{rig.node.get_name()}" == node
        case ["run", "vehicle_pf_tracker", executable, *arguments]:
            rig.bench.remove(rig.node)
            start(rig.bench, start_process, executable, arguments)
        case _:
            pytest.fail(f"no test knows ros2 {words}")


def start(bench, start_process, executable, arguments):
    """Run the executable; a file that the page only names is not there."""
    name = executable.removesuffix("_tracker")
    code = f"from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main({name!r}))"
    if name != "video_source":
        start_process("-c", code, *arguments).wait_for_output("ready: images on")
        remapped = next((one[7:] for one in arguments if one.startswith("image:=")), "image")
        camera = bench.publisher(Image, remapped)
        camera.publish(image_message(header(2), road(1, *SIZE)[0]))
    else:
        process = start_process("-c", code, *arguments)
        assert process.wait() == 1
        assert process.output.startswith("video_source: there is no file or folder")
        assert process.output.count("\n") == 1


def test_there_are_such_commands():
    verbs = {one.values[0][0] for one in COMMANDS}
    assert verbs >= {"topic", "param", "run"}
    assert len(COMMANDS) > 8
