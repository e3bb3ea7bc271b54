# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The node as a process: signals, exit statuses, and requests that are malformed."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.srv import GetState
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import Image
from tracker_rig import header, road

from vehicle_pf_tracker.ros import executables
from vehicle_pf_tracker.ros.messages import image_message

pytestmark = pytest.mark.ros


@pytest.mark.parametrize(
    "signals",
    [[signal.SIGINT] * 2, [signal.SIGTERM], [signal.SIGHUP]],
    ids=["int2", "term", "hup"],
)
def test_a_signal_ends_the_node_well(start_node, signals):
    node = start_node("apf", fresh=True)
    node.wait_for_output("ready")
    kept = shared_memory(node)
    assert kept
    for number in signals:
        node.send(number)
    assert node.wait() == 0
    assert "Traceback" not in node.output
    assert not [path for path in kept if path.exists()]


def test_a_hangup_that_nohup_ignores_does_not_end_the_node(start_process, bench):
    code = (
        "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
        "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main('apf'))"
    )
    node = start_process("-c", code)
    node.wait_for_output("ready")
    node.send(signal.SIGHUP)
    state = bench.call(GetState, "/apf_tracker/get_state", GetState.Request())
    assert state.current_state.label == "active"


def test_a_second_ctrl_c_does_not_reach_the_clean_up(start_process):
    code = (
        "import os, signal, sys\n"
        "from vehicle_pf_tracker.ros.executables import main\n"
        "from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode\n"
        "destroy = TrackerNode.destroy_node\n"
        "def interrupted(node):\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "    destroy(node)\n"
        "    print('cleaned up')\n"
        "TrackerNode.destroy_node = interrupted\n"
        "sys.exit(main('apf'))"
    )
    process = start_process("-c", code)
    process.wait_for_output("ready")
    process.send(signal.SIGINT)
    assert process.wait() == 0
    assert process.output.endswith("cleaned up\n")


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_signal_while_libraries_load_leaves_no_traceback(start_process, name):
    code = (
        "import os, signal, sys\n"
        # A shell that runs us in the background has us inherit SIGINT as ignored.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "class Interrupting:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        if name == 'vehicle_pf_tracker.ros.process':\n"
        f"            os.kill(os.getpid(), signal.{name})\n"
        "sys.meta_path.insert(0, Interrupting())\n"
        "from vehicle_pf_tracker.ros.executables import main\n"
        "sys.exit(main('apf'))"
    )
    process = start_process("-c", code, fresh=True)
    assert process.wait() == 0
    assert process.output == ""


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["-p", "num_particles:=0"], "apf_tracker: num_particles must be from 1 to 100000, got 0"),
        (["-p", "target.width:=0.5", "-p", "target.height:=20"], "smaller than one pixel"),
        (["-p", "image_transport:=theora"], "must be one of raw, compressed"),
        (["--params-file", "/nowhere.yaml"], "apf_tracker: Couldn't parse params file"),
        (["--nonsense"], "apf_tracker: unknown ROS arguments: ['--nonsense']"),
        (["-p", "qos_overrides./image.subscription.history:=often"], "QoS overrides of /image"),
    ],
)
def test_a_users_mistake_is_one_sentence_and_status_1(start_node, arguments, sentence):
    node = start_node("apf", *arguments)
    assert node.wait() == 1
    told = [line for line in node.output.splitlines() if not line.startswith("[")]
    assert len(told) == 1
    assert sentence in told[0]


def test_a_parameter_file_with_a_key_twice_is_refused(start_node, tmp_path):
    """ROS would take the last one without a word."""
    path = tmp_path / "apf.yaml"
    path.write_text("/**:\n  ros__parameters:\n    num_particles: 100\n    num_particles: 300\n")
    node = start_node("apf", "--params-file", str(path))
    assert node.wait() == 1
    assert "the key 'num_particles' is there twice" in node.output
    assert len(node.output.splitlines()) == 1


@pytest.mark.parametrize(
    ("section", "name", "full_name"),
    [
        ("/front/apf_tracker", "__node:=rear", "/rear"),
        ("/apf_tracker", "__ns:=/front", "/front/apf_tracker"),
    ],
)
def test_a_parameter_file_for_another_node_is_named_with_the_nodes_it_is_for(
    start_node, tmp_path, section, name, full_name
):
    """ROS passes over it without a word."""
    path = tmp_path / "front.yaml"
    path.write_text(f"{section}:\n  ros__parameters:\n    num_particles: 100\n")
    node = start_node("apf", "--params-file", str(path), "-r", name)
    node.wait_for_output(f"has nothing for {full_name}, only for {section}; use /** as")


def test_a_signal_while_the_node_is_made_leaves_no_words(start_process):
    code = (
        "import os, signal, sys\n"
        "import rclpy.node\n"
        "from vehicle_pf_tracker.ros.executables import main\n"
        "make = rclpy.node._rclpy.Node\n"
        "def interrupted(*words):\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "    return make(*words)\n"
        "rclpy.node._rclpy.Node = interrupted\n"
        "sys.exit(main('apf'))"
    )
    process = start_process("-c", code)
    assert process.wait() == 0
    assert process.output == ""


def test_other_arguments_are_a_usage_error(start_process):
    code = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main('apf'))"
    process = start_process("-c", code, "--target", "1,2,3,4", fresh=True)
    assert process.wait() == 2
    assert "unknown arguments: --target 1,2,3,4" in process.output
    assert "usage: apf_tracker" in process.output


def test_help_is_no_error(start_process):
    code = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main('pf'))"
    process = start_process("-c", code, "--help", fresh=True)
    assert process.wait() == 0
    assert "vehicle-pf-tracker params pf" in process.output


@pytest.mark.parametrize("name", ["pf_tracker", "pf_tracker.exe"])
def test_an_executable_runs_the_variant_it_is_named_after(monkeypatch, capfd, name):
    monkeypatch.setattr("sys.argv", [f"/opt/ws/lib/vehicle_pf_tracker/{name}", "--help"])
    assert executables.main() == 0
    assert "usage: pf_tracker" in capfd.readouterr().out


def test_an_unknown_variant_is_one_sentence(capfd):
    assert executables.main("apv") == 1
    said = "apv_tracker: there is no variant 'apv' (did you mean 'apf'?); choose one"
    assert capfd.readouterr().err.startswith(said)


def test_a_malformed_request_does_not_end_the_node(bench, start_node):
    """rclpy's own parameter service raises at a value type that it does not know."""
    node = start_node("apf")
    node.wait_for_output("ready")
    client = bench.node.create_client(SetParameters, "/apf_tracker/set_parameters")
    bench.wait_for(client.service_is_ready)
    bad = Parameter(name="num_particles", value=ParameterValue(type=77))
    client.call_async(SetParameters.Request(parameters=[bad]))
    node.wait_for_output("a request could not be answered")
    camera = bench.publisher(Image, "image")
    modes = bench.collect(DiagnosticArray, "/apf_tracker/mode")
    bench.publish_until(lambda: modes, camera, image_message(header(0), road(1)[0]))
    assert modes[0].status[0].message == "WAITING"


def test_two_nodes_live_under_their_namespaces(bench, start_node):
    for side in ("left", "right"):
        start_node("pf", "-r", f"__ns:=/{side}").wait_for_output("ready")
    cameras = [bench.publisher(Image, f"/{side}/image") for side in ("left", "right")]
    heard = [
        bench.collect(DiagnosticArray, f"/{side}/pf_tracker/mode") for side in ("left", "right")
    ]
    for index, camera in enumerate(cameras):
        image = image_message(header(index), road(1)[0])
        bench.publish_until(lambda: heard[index], camera, image)  # noqa: B023 - called at once
    assert [modes[0].header for modes in heard] == [header(0), header(1)]
    assert all(message.header == header(0) for message in heard[0])


def test_the_node_loads_neither_recordings_nor_evaluation():
    code = (
        "import sys; from vehicle_pf_tracker.ros import process; "
        "from vehicle_pf_tracker.ros.node import tracker_node; "
        "print(*sorted(name for name in sys.modules if name.startswith('vehicle_pf_tracker.')))"
    )
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout
    rooms = {name.split(".")[1] for name in loaded.split()}
    assert rooms == {
        "ros", "showing", "results", "road", "trackers", "image", "filtering", "parameters", "core",
    }  # fmt: skip
    assert "player" not in loaded


def shared_memory(process) -> set[Path]:
    """Segments of Fast DDS that a process has made: those that carry its lock."""
    maps = Path("/proc", str(process.popen.pid), "maps").read_text().splitlines()
    return {
        Path(line.split()[-1]) for line in maps if re.search("/fast(rtps|dds)_[0-9a-f]+$", line)
    }


def segments(process) -> list[int]:
    """Sizes in bytes of the shared-memory segments of Fast DDS that a process has mapped."""
    maps = Path("/proc", str(process.popen.pid), "maps").read_text().splitlines()
    spans = [line.split()[0].split("-") for line in maps if re.search("/fast(rtps|dds)_", line)]
    return [int(end, 16) - int(begin, 16) for begin, end in spans]


def test_a_node_has_room_for_its_overlays(start_node):
    node = start_node("apf")
    node.wait_for_output("ready")
    assert max(segments(node)) >= 4 * 1280 * 720 * 3
