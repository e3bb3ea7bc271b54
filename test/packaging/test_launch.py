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

"""What the launch files start. `launch` is not on PyPI: these run where ROS comes from apt."""

import os
from pathlib import Path

import pytest

# Not importorskip("launch"): our folder of that name would pass for it.
pytest.importorskip("launch.launch_description_sources", exc_type=ImportError)
pytest.importorskip("launch_ros.actions", exc_type=ImportError)

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.launch_description_sources import get_launch_description_from_python_launch_file
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions import Node

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
    for name in ("apf_tracker", "pf_tracker", "bag_replay"):
        (executables / name).touch(mode=0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    return tmp_path / "share" / "vehicle_pf_tracker"


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


def command(context, node):
    node._perform_substitutions(context)
    return [text(context, part) for part in node.cmd]


def test_tracker_starts_the_node_of_the_variant(share):
    context, (node,) = started("tracker", variant="pf", image_topic="/front/image", namespace="car")
    assert text(context, node.node_package) == "vehicle_pf_tracker"
    assert text(context, node.node_executable) == "pf_tracker"
    node._perform_substitutions(context)
    assert node.node_name == "/car/pf_tracker"
    assert node.expanded_remapping_rules == [
        ("image", "/front/image"),
        ("image/compressed", "/front/image/compressed"),
    ]


def test_every_argument_has_a_description():
    for name in ("tracker", "replay"):
        path = ROOT / "launch" / f"{name}.launch.py"
        description = get_launch_description_from_python_launch_file(str(path))
        assert isinstance(description, LaunchDescription)
        for entity in description.entities:
            if isinstance(entity, DeclareLaunchArgument):
                assert entity.description


@pytest.mark.parametrize(("given", "expected"), [(None, "1073741824"), ("5", "5")])
def test_the_users_allocator_settings_stay(monkeypatch, given, expected):
    name = "MALLOC_MMAP_THRESHOLD_"
    monkeypatch.delenv(name, raising=False)
    if given:
        monkeypatch.setenv(name, given)
    context, (node,) = started("tracker")
    added = {text(context, list(k)): text(context, list(v)) for k, v in node.additional_env}
    assert added[name] == expected
    assert set(added) == {name, "MALLOC_TRIM_THRESHOLD_", "MALLOC_TOP_PAD_"}
    assert os.environ.get(name) == given


def test_replay_plays_the_recording_to_the_tracker():
    context, nodes = started("replay", recording="/data/highway", rate="0.5", variant="pf")
    assert [text(context, node.node_executable) for node in nodes] == ["pf_tracker", "bag_replay"]
    words = command(context, nodes[1])
    assert words[1:4] == ["/data/highway", "--rate", "0.5"]
    assert "--loop" not in words


def test_replay_loops_when_asked():
    context, nodes = started("replay", recording="/data/highway", loop="true")
    assert "--loop" in command(context, nodes[1])


@pytest.mark.parametrize(("target", "told"), [("", []), ("1,2,30,40", ["--target", "1,2,30,40"])])
def test_replay_passes_a_target_on(target, told):
    context, nodes = started("replay", recording="/data/highway", target=target)
    words = command(context, nodes[1])
    assert words[words.index("--decompress") + 1 :][: len(told)] == told
    assert ("--target" in words) == bool(told)
