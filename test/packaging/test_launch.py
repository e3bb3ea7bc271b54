# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What the launch files start. `launch` is not on PyPI: these run where ROS comes from apt."""

from pathlib import Path

import cv2
import numpy as np
import pytest

# Not importorskip("launch"): our folder of that name would pass for it.
pytest.importorskip("launch.launch_description_sources", exc_type=ImportError)
pytest.importorskip("launch_ros.actions", exc_type=ImportError)

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.launch_description_sources import get_launch_description_from_python_launch_file
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import Parameter
from launch_ros.utilities import evaluate_parameters

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.ros.transport import PROFILE_VARIABLES
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT, plug_ins

TRAFFIC_NAMES = set(Configuration.of(TRAFFIC_VARIANT).specs())
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def share(monkeypatch, tmp_path):
    """A workspace whose share folder is this checkout, and whose executables are empty."""
    marker = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
    marker.mkdir(parents=True)
    (marker / "vehicle_pf_tracker").touch()
    (tmp_path / "share" / "vehicle_pf_tracker").symlink_to(ROOT)
    executables = tmp_path / "lib" / "vehicle_pf_tracker"
    executables.mkdir(parents=True)
    variants = ("apf", "pf", "fusion", "traffic", "vehicle")
    for name in (*(f"{variant}_tracker" for variant in variants), "bag_replay"):
        (executables / name).touch(mode=0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    return tmp_path / "share" / "vehicle_pf_tracker"


def record(folder, *, compressed=False):
    """Record two images."""
    with RecordingWriter(folder) as writer:
        frame = np.zeros((8, 8, 3), np.uint8)
        for stamp in (1, 2):
            if compressed:
                writer.write_compressed(stamp, "png", cv2.imencode(".png", frame)[1].tobytes())
            else:
                writer.write_image(stamp, frame)


def started(name, **arguments):
    """The context after launch has visited the file, and the nodes it would start."""
    context = LaunchContext()
    context.launch_configurations.update(arguments)
    path = ROOT / "launch" / f"{name}.launch.py"
    nodes = []
    visit(get_launch_description_from_python_launch_file(str(path)), context, nodes)
    return context, nodes


def visit(entity, context, nodes):
    if entity.__class__ is Node:
        if entity.condition is None or entity.condition.evaluate(context):
            nodes.append(entity)
        return
    assert not isinstance(entity, ExecuteProcess)
    for inner in entity.visit(context) or []:
        visit(inner, context, nodes)


def text(context, value):
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


def resolve(context, node):
    """Let `node` work out its name and remappings, as it does before it starts a process."""
    node._perform_substitutions(context)


def command(context, node):
    resolve(context, node)
    words = [text(context, part) for part in node.cmd]
    return words[: words.index("--ros-args")] if "--ros-args" in words else words


def test_tracker_starts_the_node_of_the_variant(share):
    context, (node,) = started("tracker", variant="pf", image_topic="/front/image", namespace="car")
    assert text(context, node.node_package) == "vehicle_pf_tracker"
    assert text(context, node.node_executable) == "pf_tracker"
    resolve(context, node)
    assert node.node_name == "/car/pf_tracker"
    assert node.expanded_remapping_rules == [
        ("image", "/front/image"),
        ("image/compressed", "/front/image/compressed"),
    ]


def test_every_argument_has_a_description():
    for name in ("tracker", "traffic", "replay", "cameras"):
        path = ROOT / "launch" / f"{name}.launch.py"
        description = get_launch_description_from_python_launch_file(str(path))
        assert isinstance(description, LaunchDescription)
        for entity in description.entities:
            if isinstance(entity, DeclareLaunchArgument):
                assert entity.description


def test_traffic_starts_its_node_on_the_defaults():
    context, (node,) = started("traffic")
    resolve(context, node)
    assert node.node_name == "/traffic_tracker"
    assert node.expanded_remapping_rules == [
        ("image", "/camera/image_raw"),
        ("image/compressed", "/camera/image_raw/compressed"),
    ]
    assert parameters_of(context, node) == {"use_sim_time": False}
    assert [Path(one).name for one in parameter_files(context, node)] == ["traffic.yaml"]


@pytest.mark.parametrize("name", ["traffic", "tracker"])
def test_traffic_takes_detections_and_lines(name):
    context, (node,) = started(
        name, variant="traffic", detections_topic="/yolo/detections", lines="/etc/lines.yaml",
        image_topic="/gate/image", namespace="gate", log_level="warn",
    )  # fmt: skip
    resolve(context, node)
    assert node.node_name == "/gate/traffic_tracker"
    assert ("detections", "/yolo/detections") in node.expanded_remapping_rules
    assert ("image", "/gate/image") in node.expanded_remapping_rules
    own = {"use_sim_time": False, "detector.kind": "topic", "lines": "/etc/lines.yaml"}
    assert parameters_of(context, node) == own
    assert own.keys() - {"use_sim_time"} <= TRAFFIC_NAMES


def test_the_names_of_traffics_arguments_are_those_of_the_tracker():
    path = ROOT / "launch" / "{}.launch.py"
    names = [
        {
            entity.name
            for entity in get_launch_description_from_python_launch_file(
                str(path).format(name)
            ).entities
            if isinstance(entity, DeclareLaunchArgument)
        }
        for name in ("tracker", "traffic")
    ]
    assert names[1] == names[0] - {"variant"}


@pytest.fixture
def bag(tmp_path):
    record(tmp_path / "bag")
    return str(tmp_path / "bag")


def test_replay_plays_the_recording_to_the_tracker(bag):
    context, nodes = started("replay", recording=bag, rate="0.5", variant="pf", namespace="car")
    assert [text(context, node.node_executable) for node in nodes] == ["pf_tracker", "bag_replay"]
    words = command(context, nodes[1])
    assert words[1:] == [
        bag, "--topic", "/camera/image_raw", "--rate", "0.5",
        "--node", "car/pf_tracker", "--timeout", "60",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("argument", "told"),
    [
        ({"loop": "true"}, ["--loop"]),
        ({"target": "1,2,30,40"}, ["--target", "1,2,30,40"]),
        ({"use_sim_time": "true"}, ["--clock", "100"]),
        ({"variant": "traffic"}, ["--no-target"]),
    ],
)
def test_replay_passes_arguments_on(bag, argument, told):
    context, nodes = started("replay", recording=bag, **argument)
    assert command(context, nodes[1])[-len(told) :] == told
    without, nodes = started("replay", recording=bag)
    assert told[0] not in command(without, nodes[1])


def test_the_node_hears_what_was_recorded(tmp_path):
    record(tmp_path / "bag", compressed=True)
    context, nodes = started("replay", recording=str(tmp_path / "bag"), topic="")
    resolve(context, nodes[0])
    assert ("image", "/camera/image_raw") in nodes[0].expanded_remapping_rules
    assert parameters_of(context, nodes[0])["image_transport"] == "compressed"


def parameters_of(context, node):
    evaluated = evaluate_parameters(context, node._Node__parameters)
    return dict(one.evaluate(context) for one in evaluated if isinstance(one, Parameter))


def test_nothing_is_written_for_arguments(monkeypatch, tmp_path):
    written = tmp_path / "written"
    written.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(written))
    context, (node,) = started("tracker", use_sim_time="true", image_transport="compressed")
    resolve(context, node)
    assert parameters_of(context, node) == {"use_sim_time": True, "image_transport": "compressed"}
    assert not list(written.iterdir())


def parameter_files(context, node):
    evaluated = evaluate_parameters(context, node._Node__parameters)
    return [str(one) for one in evaluated if isinstance(one, Path)]


def test_included_twice_each_has_its_own_file():
    context = LaunchContext()
    nodes = []
    path = ROOT / "launch" / "tracker.launch.py"
    for variant in ("apf", "pf"):
        context.launch_configurations["variant"] = variant
        visit(get_launch_description_from_python_launch_file(str(path)), context, nodes)
    files = [parameter_files(context, node) for node in nodes]
    assert [Path(one).name for (one,) in files] == ["apf.yaml", "pf.yaml"]


def test_a_mistyped_parameter_file_is_an_error():
    with pytest.raises(InputError, match=r"cannot read the parameter file /nowhere/apf\.yaml"):
        started("tracker", params_file="/nowhere/apf.yaml")


def test_cameras_start_a_node_each(tmp_path):
    path = tmp_path / "cameras.yaml"
    path.write_text(
        "cameras:\n  front: {topic: /f/image, variant: pf, target: [1, 2, 30, 40]}\n"
        "  rear: {topic: /r/image}\n"
    )
    context, nodes = started("cameras", cameras=str(path))
    for node in nodes:
        resolve(context, node)
    assert [node.node_name for node in nodes] == ["/front/pf_tracker", "/rear/fusion_tracker"]
    assert ("image", "/r/image") in nodes[1].expanded_remapping_rules


def test_cameras_in_a_container_share_a_process(tmp_path):
    path = tmp_path / "cameras.yaml"
    path.write_text("cameras: {front: {topic: /f/image}, rear: {topic: /r/image}}\n")
    context, (node,) = started("cameras", cameras=str(path), container="true")
    words = command(context, node)
    assert words[0].endswith("/vehicle_tracker")
    assert words[1:] == ["--cameras", str(path)]
    assert parameters_of(context, node) == {"use_sim_time": False}
    assert "__node:=" not in str(node.cmd)  # it would rename all of them


def test_a_plug_in_has_the_executable_of_any(tmp_path, monkeypatch):
    info = tmp_path / "own-1.dist-info"
    info.mkdir()
    (info / "entry_points.txt").write_text("[vehicle_pf_tracker.variants]\nown = own:OwnTracker\n")
    monkeypatch.syspath_prepend(tmp_path)
    plug_ins.cache_clear()
    context, (node,) = started("tracker", variant="own")
    assert text(context, node.node_executable) == "vehicle_tracker"
    assert [text(context, word) for word in node._Node__arguments] == ["--variant", "own"]
    resolve(context, node)
    assert node.node_name == "/own_tracker"
    assert not parameter_files(context, node)
    plug_ins.cache_clear()


def test_a_viewer_is_opened_on_the_node(share):
    context, nodes = started("traffic", rviz="true", foxglove="true", namespace="gate")
    packages = [text(context, node.node_package) for node in nodes]
    assert packages == ["vehicle_pf_tracker", "rviz2", "foxglove_bridge"]
    layout = text(context, nodes[1]._Node__arguments[1])
    assert "Value: /gate/traffic_tracker/overlay" in Path(layout).read_text(encoding="utf-8")


@pytest.mark.parametrize("is_terminal", [False, True])
def test_no_escape_codes_go_into_a_log(monkeypatch, bag, is_terminal):
    monkeypatch.setattr("sys.stdout.isatty", lambda: is_terminal, raising=False)
    _, nodes = started("replay", recording=bag)
    assert [node._ExecuteLocal__emulate_tty for node in nodes] == [is_terminal] * 2


def test_large_images_set_both_variables(monkeypatch):
    for name in PROFILE_VARIABLES:
        monkeypatch.delenv(name, raising=False)
    context, _ = started("tracker", large_images="true")
    found = {context.environment[name] for name in PROFILE_VARIABLES}
    assert len(found) == 1
    assert "segment_size" in Path(found.pop()).read_text(encoding="utf-8")
